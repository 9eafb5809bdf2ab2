#include "control/feedforward/free_motion.h"

#include <algorithm>
#include <cmath>

#include "control/feedforward/running_model.h"
#include "model/chain.h"

namespace softgrip::control {
namespace {

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
