#pragma once
// Computes the feedforward of a complete reference before the sequence starts: the command with which the
// model follows this reference.

#include <functional>
#include <stop_token>
#include <vector>

#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "control/feedforward/pressure_plan.h"
#include "model/model.h"

namespace softgrip::model {
template <class T>
class Chain;
}

namespace softgrip::control {

/// Finds the command u by least squares over the reference, within the pressure range and the slew limits:
///
///   minimise  sum (y(t_i) - r(t_i))^2 + (w (u_{i+1} - 2 u_i + u_{i-1}))^2
///
/// Here r is the reference, w is a small weight, and y is the response of the model with lag and saturation.
/// The response has no dead time, because the preview compensates the dead time. The method needs no inverse
/// of the model, so it also serves models with an inverse response. For such a model, the command changes
/// before the reference changes.
///
/// The problem is solved by the Levenberg-Marquardt method in windows of a few seconds. Each window extends
/// 1.5 s beyond the part whose commands it determines. With windows, the computing time is proportional to
/// the length of the reference. Without windows, it would be proportional to the cube of this length. The
/// Jacobian has one column per point of the command. For each column, the chain is simulated from the point
/// to the end of the window. The bounds of the command are one-sided residuals with a large weight. At the
/// end, limit() enforces these bounds exactly.
class Planner {
 public:
  /// Starts with the model at rest under the rest pressure. The time between two points of a plan is at least
  /// `tick_s`, the period of the loop.
  Planner(const model::Model& model, const LimitSettings& limits, double tick_s);

  /// Returns the plan for a reference over [from_s, to_s]. The model continues from the end of the previous
  /// plan, so one Planner computes all plans of a sequence. After a request through `stop`, returns the part
  /// of the plan that is complete.
  [[nodiscard]] PressurePlan plan(const Reference& reference, double from_s, double to_s,
                                  const std::stop_token& stop = {});

  /// Advances the model by `duration_s` under commands that are not planned. `command_kpa` returns the
  /// command for a time after the start of this period. The commands are limited to the pressure range and
  /// the slew limits.
  void drive(const std::function<double(double time_s)>& command_kpa, double duration_s);

  /// command_kpa() returns the last command [kPa]. displacement_mm() returns the model's displacement after
  /// the last command [mm].
  [[nodiscard]] double command_kpa() const noexcept;
  [[nodiscard]] double displacement_mm() const;

 private:
  [[nodiscard]] model::Chain<double> finger() const;
  void add_point(double wanted_kpa, model::Chain<double>& chain, PressurePlan& plan);

  model::Model model_;  ///< model from which the dead time was removed
  LimitSettings limits_;
  double step_s_;
  SettledLine settled_;
  std::vector<double> past_kpa_;  ///< all commands since the finger was at rest
};

}  // namespace softgrip::control
