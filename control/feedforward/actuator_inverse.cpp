#include "control/feedforward/actuator_inverse.h"

#include <algorithm>
#include <cmath>

#include "model/dual.h"

namespace softgrip::control {
namespace {

constexpr double tolerance_mm = 1e-11;
/// A Newton step that is not larger than this pressure is accepted without a further evaluation of the model.
/// If the curvature of displacement over pressure is below 0.05 mm/kPa^2, the error of the displacement is
/// then at most 1e-11 mm.
constexpr double last_step_kpa = 2e-5;
/// Number of Newton steps after which bisection replaces the Newton iteration. For a chain without sharp
/// kinks, a few Newton steps are sufficient. An iteration that needs more steps than this number oscillates
/// between two kinks.
constexpr int newton_iterations = 20;
constexpr int most_iterations = 80;

}  // namespace

ActuatorInverse::ActuatorInverse(const model::Model& body, double tick_s)
    : tick_s_(tick_s), body_(body, {}, tick_s) {}

// The attribute inlines all function calls of solve(). Without inlining, solve() takes one third more time.
[[gnu::flatten]] ActuatorInverse::Solution ActuatorInverse::solve(double displacement_mm, double lower_kpa,
                                                                  double upper_kpa) const noexcept {
  using Number = model::Dual<double>;
  const double guess = 3 * (past_kpa_[0] - past_kpa_[1]) + past_kpa_[2];
  double x = std::clamp(guess, lower_kpa, upper_kpa);
  double lower = lower_kpa;
  double upper = upper_kpa;
  bool lower_tried = false, upper_tried = false;
  for (int i = 0; i < most_iterations; ++i) {
    const Number y = body_.peek(tick_s_, Number(x, 1));
    const double miss = y.a - displacement_mm;
    if (std::abs(miss) <= tolerance_mm) return {x, true};
    (miss > 0 ? upper : lower) = x;
    lower_tried = lower_tried || x == lower_kpa;
    upper_tried = upper_tried || x == upper_kpa;
    // The solution is beyond this bound, or the bracket is empty. In both cases, the bound is the nearest
    // possible pressure.
    if (x == upper_kpa && miss < 0) return {x, false};
    if (x == lower_kpa && miss > 0) return {x, false};
    const double next = x - miss / y.v;
    if (i >= newton_iterations || !(next > lower && next < upper)) {
      // If a bound was not evaluated yet, the bound is evaluated next, because the bound itself may be the
      // solution.
      const double bound = miss < 0 ? upper : lower;
      const bool untried = miss < 0 ? bound == upper_kpa && !upper_tried : bound == lower_kpa && !lower_tried;
      const double middle = 0.5 * (lower + upper);
      if (!untried && !(middle > lower && middle < upper)) return {x, true};
      x = untried ? bound : middle;
      continue;
    }
    // The slope of displacement over pressure jumps at the pressure of the last tick, where the direction of
    // the pressure reverses. A last step that crosses this pressure would use the wrong slope, so it is not
    // accepted.
    const bool same_side = (x - past_kpa_[0]) * (next - past_kpa_[0]) > 0;
    if (same_side && std::abs(next - x) <= last_step_kpa) return {next, true};
    if (next == x) return {x, true};
    x = next;
  }
  return {x, false};
}

void ActuatorInverse::advance(double pressure_kpa) noexcept {
  body_.step(tick_s_, pressure_kpa);
  past_kpa_ = {pressure_kpa, past_kpa_[0], past_kpa_[1]};
}

void ActuatorInverse::take_over(const model::Chain<double>& body, double pressure_kpa) noexcept {
  body_ = body;
  past_kpa_ = {pressure_kpa, pressure_kpa, pressure_kpa};
}

double ActuatorInverse::displacement_at(double pressure_kpa) const noexcept {
  return body_.peek(tick_s_, pressure_kpa);
}

}  // namespace softgrip::control
