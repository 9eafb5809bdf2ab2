#pragma once
// Computes a feedforward before the sequence starts: the command with which the model follows a complete
// reference.

#include <cstddef>
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
/// The response has no dead time, because the preview compensates the dead time. No inverse is needed, so
/// models with an inverse response can be planned too: the plan starts to act before the reference changes.
///
/// The problem is solved by the Levenberg-Marquardt method in windows of a few seconds. Each window extends
/// 1.5 s beyond the part whose commands it determines. Therefore, the computing time increases in proportion
/// to the length of the reference, and not to its cube. The Jacobian has one column per point of the command.
/// Each column is computed with the chain from this point to the end of the window. The bounds are one-sided
/// residuals with a large weight. In the end, limit() enforces the bounds exactly.
class Planner {
 public:
  /// Starts with a finger at rest under the rest pressure. The time between two points of a plan is at least
  /// `tick_s`, the period of the loop.
  Planner(const model::Model& model, const LimitSettings& limits, double tick_s);

  /// Returns the plan for a reference over [from_s, to_s]. The model continues from the end of the last plan,
  /// so one Planner serves a complete sequence. After a stop request, returns the part of the plan that is
  /// complete.
  [[nodiscard]] PressurePlan plan(const Reference& reference, double from_s, double to_s,
                                  const std::stop_token& stop = {});

  /// Advances the model by `duration_s` under commands that are not planned. `command_kpa` returns the
  /// command for a time since the start of this call. The commands are limited to the pressure range and the
  /// slew limits.
  void drive(const std::function<double(double time_s)>& command_kpa, double duration_s);

  /// command_kpa() returns the last command, and displacement_mm() returns the model's displacement after
  /// this command.
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
