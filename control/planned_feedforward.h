#pragma once
// A feedforward computed before the run: the command that makes the model follow a whole reference.

#include <cstddef>
#include <vector>

#include "control/limits.h"
#include "control/reference.h"
#include "model/model.h"

namespace softgrip::control {

/// A command over time, straight between its points. Its clock is that of the finger without dead time: what
/// stands at a time must act on the valve one dead time earlier. Plain values; at() allocates nothing.
struct PressurePlan {
  double start_s = 0;  ///< of the first point, on the reference's clock
  double step_s = 0;   ///< from point to point
  std::vector<double> pressure_kpa;
  std::vector<double> displacement_mm;  ///< what the model then does, at the same times
  double rmse_mm = 0;                   ///< of the model against the reference

  /// The command, its first value before and its last value after the plan [kPa]; 0 of an empty plan.
  [[nodiscard]] double at(double time_s) const noexcept;
  /// How far the model is from `wanted_mm` then [mm]: a reference that is out of reach.
  [[nodiscard]] double miss_mm(double time_s, double wanted_mm) const noexcept;
};

/// Least squares over the reference within the pressure range and the slew limits:
///
///   minimise  sum (y(t_i) - r(t_i))^2 + (w (u_{i+1} - 2 u_i + u_{i-1}))^2
///
/// with y the model's answer, dead time taken out (it is made up for by preview), lag and saturation kept in.
/// No inverse is needed, so models that move the wrong way first are served as well: the plan acts before the
/// reference does, as far as it is given time for that.
///
/// Levenberg-Marquardt over windows of a few seconds that look a little further than they decide, so that the
/// time grows with the length of the reference and not with its cube. The derivatives are those of the chain
/// itself, one column per point of the command from there to the window's end. Bounds are put into the
/// residuals as heavy one-sided rows and then kept exactly by limit().
class Planner {
 public:
  /// At rest under the lowest command. `tick_s` of the loop bounds how fine a plan is.
  Planner(const model::Model& model, const LimitSettings& limits, double tick_s);

  /// The plan for a reference over [from_s, to_s]. The model goes on from where the plan before left it: a
  /// Planner is the memory of a sequence.
  [[nodiscard]] PressurePlan plan(const Reference& reference, double from_s, double to_s);

  /// How long before a change of the reference a plan should begin, so that what moves the wrong way first
  /// has moved by then [s].
  static constexpr double lead_s = 0.6;

 private:
  model::Model model_;  ///< without dead time
  LimitSettings limits_;
  double step_s_;
  std::vector<double> past_kpa_;  ///< everything that was planned, from rest on
};

}  // namespace softgrip::control
