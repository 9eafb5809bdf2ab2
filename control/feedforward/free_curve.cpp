#include "control/feedforward/free_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/feedforward/running_model.h"
#include "model/chain.h"

namespace softgrip::control {
namespace {

constexpr int levels = 32;
constexpr std::size_t points = 65;
constexpr double curve_step_s = 0.02;

/// The state of a finger that has settled under a constant command.
struct Level {
  double command_kpa = 0;
  double pressure_kpa = 0;
  double displacement_mm = 0;
};

/// Returns the settled states of the finger, from the lowest to the highest command. A state whose
/// displacement does not exceed that of the previous state is left out. The simulation reaches each state
/// from rest.
std::vector<Level> levels_of(const model::Model& model, const LimitSettings& limits) {
  model::Chain<double> valve(valve_of(model), {}, curve_step_s);
  model::Chain<double> body(body_of(model), {}, curve_step_s);
  const bool has_valve = valve.size() > 0;
  std::vector<Level> found;
  const double rest_kpa = resting_kpa(limits);
  const long rest_steps = std::lround(rests_after_s / curve_step_s);
  for (int i = 0; i <= levels; ++i) {
    const double range_kpa = limits.pressure_max_kpa - limits.pressure_min_kpa;
    Level level{.command_kpa = limits.pressure_min_kpa + range_kpa * i / levels};
    valve.reset(rest_kpa);
    const auto pressure = [&] { return has_valve ? valve.pressure_kpa() : level.command_kpa; };
    body.reset(has_valve ? valve.pressure_kpa() : rest_kpa);
    valve.step(0, level.command_kpa);
    body.step(0, pressure());
    for (long k = 0; k < rest_steps; ++k) {
      valve.step(curve_step_s, level.command_kpa);
      body.step(curve_step_s, pressure());
    }
    level.pressure_kpa = pressure();
    level.displacement_mm = body.reading_mm();
    if (found.empty() || level.displacement_mm > found.back().displacement_mm) found.push_back(level);
  }
  return found;
}

constexpr double finest_step_s = 0.002;
constexpr int most_steps = 2000;

/// A finger that starts at rest under the rest pressure.
class Finger {
 public:
  Finger(const model::Model& model, double rest_kpa)
      : valve_(valve_of(model)), body_(body_of(model)), has_valve_(valve_.size() > 0) {
    valve_.reset(rest_kpa);
    body_.reset(has_valve_ ? valve_.pressure_kpa() : rest_kpa);
    step(0, rest_kpa);
  }

  [[nodiscard]] double displacement_mm() const { return body_.reading_mm(); }
  [[nodiscard]] double fastest_mm_per_s() const { return fastest_mm_per_s_; }

  /// Moves the pressure from `from_kpa` to `to_kpa` along a ramp, and waits at `to_kpa`.
  void go(double from_kpa, double to_kpa, double slew_kpa_per_s) {
    const double ramp_s = std::abs(to_kpa - from_kpa) / slew_kpa_per_s;
    const double step_s = std::max(finest_step_s, ramp_s / most_steps);
    const int ramp = static_cast<int>(std::ceil(ramp_s / step_s));
    for (int i = 1; i <= ramp; ++i) step(step_s, from_kpa + (to_kpa - from_kpa) * i / ramp);
    const int rest = static_cast<int>(std::ceil(rests_after_s / step_s));
    for (int i = 0; i < rest; ++i) step(step_s, to_kpa);
  }

 private:
  void step(double step_s, double command_kpa) {
    const double before_mm = step_s > 0 ? displacement_mm() : 0;
    valve_.step(step_s, command_kpa);
    body_.step(step_s, has_valve_ ? valve_.pressure_kpa() : command_kpa);
    if (step_s > 0) {
      fastest_mm_per_s_ = std::max(fastest_mm_per_s_, std::abs(displacement_mm() - before_mm) / step_s);
    }
  }

  model::Chain<double> valve_;
  model::Chain<double> body_;
  bool has_valve_;
  double fastest_mm_per_s_ = 0;
};

}  // namespace

FreeCurve::FreeCurve(const model::Model& model, const LimitSettings& limits) {
  const std::vector<Level> rests = levels_of(model, limits);
  const Level& first = rests.front();
  const Level& last = rests.back();
  lowest_mm_ = first.displacement_mm;
  if (rests.size() > 1) {
    const double range_mm = last.displacement_mm - first.displacement_mm;
    step_mm_ = range_mm / static_cast<double>(points - 1);
    slope_kpa_per_mm_ = (last.command_kpa - first.command_kpa) / range_mm;
  }
  std::size_t k = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const double y_mm = lowest_mm_ + step_mm_ * static_cast<double>(i);
    while (k + 2 < rests.size() && rests[k + 1].displacement_mm < y_mm) ++k;
    const Level& a = rests[k];
    const Level& b = rests[std::min(k + 1, rests.size() - 1)];
    const double gap_mm = b.displacement_mm - a.displacement_mm;
    const double share = gap_mm > 0 ? (y_mm - a.displacement_mm) / gap_mm : 0;
    command_kpa_.push_back(a.command_kpa + share * (b.command_kpa - a.command_kpa));
    pressure_kpa_.push_back(a.pressure_kpa + share * (b.pressure_kpa - a.pressure_kpa));
  }
}

double FreeCurve::at(const std::vector<double>& table, double displacement_mm) const noexcept {
  if (!(step_mm_ > 0)) return table.front();
  const double place = (displacement_mm - lowest_mm_) / step_mm_;
  const double last = static_cast<double>(points - 1);
  if (!(place > 0)) return table.front() + place * step_mm_ * slope_kpa_per_mm_;
  if (place >= last) return table.back() + (place - last) * step_mm_ * slope_kpa_per_mm_;
  const auto whole = static_cast<std::size_t>(place);
  return table[whole] + (place - static_cast<double>(whole)) * (table[whole + 1] - table[whole]);
}

double FreeCurve::squeeze_for_kpa(double shortfall_mm) const noexcept {
  double most = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const double y_mm = lowest_mm_ + step_mm_ * static_cast<double>(i);
    most = std::max(most, command_kpa(y_mm + shortfall_mm) - command_kpa(y_mm));
  }
  return most;
}

FreeMotion free_motion(const model::Model& model, const LimitSettings& limits) {
  const double rest_kpa = resting_kpa(limits);
  Finger finger(model, rest_kpa);
  FreeMotion motion;
  motion.rest_mm = motion.lowest_mm = motion.highest_mm = finger.displacement_mm();
  if (limits.pressure_max_kpa > rest_kpa) {
    finger.go(rest_kpa, limits.pressure_max_kpa, limits.slew_up_kpa_per_s);
    motion.highest_mm = finger.displacement_mm();
    finger.go(limits.pressure_max_kpa, rest_kpa, limits.slew_down_kpa_per_s);
  }
  if (limits.pressure_min_kpa < rest_kpa) {
    finger.go(rest_kpa, limits.pressure_min_kpa, limits.slew_down_kpa_per_s);
    motion.lowest_mm = finger.displacement_mm();
    finger.go(limits.pressure_min_kpa, rest_kpa, limits.slew_up_kpa_per_s);
  }
  motion.fastest_mm_per_s = finger.fastest_mm_per_s();
  return motion;
}

}  // namespace softgrip::control
