#pragma once
// Computes a feedforward before the run: the command with which the model follows a complete reference.

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

/// Least squares over the reference within the pressure range and the slew limits:
///
///   minimise  sum (y(t_i) - r(t_i))^2 + (w (u_{i+1} - 2 u_i + u_{i-1}))^2
///
/// Here y is the response of the model with lag and saturation, but without its dead time, which preview
/// compensates. No inverse is needed, so models with an inverse response can be planned too: the plan acts
/// before the reference changes, as far as its time allows.
///
/// Levenberg-Marquardt over windows of a few seconds. Each window looks a little further ahead than it
/// decides. So the time increases with the length of the reference, not with its cube. The derivatives are
/// those of the chain: one column per point of the command, from this point to the end of the window. Bounds
/// are heavy one-sided rows of the residuals; after that, limit() enforces them exactly.
class Planner {
 public:
  /// Starts at rest under the lowest command. `tick_s` of the loop limits how fine a plan is.
  Planner(const model::Model& model, const LimitSettings& limits, double tick_s);

  /// Returns the plan for a reference over [from_s, to_s]. The model continues from the end of the last plan,
  /// so one Planner is used for a complete sequence. After a stop request, it returns the plan so far.
  [[nodiscard]] PressurePlan plan(const Reference& reference, double from_s, double to_s,
                                  const std::stop_token& stop = {});

  /// Advances the model while other commands move the finger: `command_kpa` after the start, within the
  /// limits.
  void drive(const std::function<double(double time_s)>& command_kpa, double duration_s);

  /// Returns the last command; displacement_mm() is the model's displacement after it.
  [[nodiscard]] double command_kpa() const noexcept;
  [[nodiscard]] double displacement_mm() const;

 private:
  [[nodiscard]] model::Chain<double> finger() const;
  void add_point(double wanted_kpa, model::Chain<double>& chain, PressurePlan& plan);

  model::Model model_;  ///< without dead time
  LimitSettings limits_;
  double step_s_;
  SettledLine settled_;
  std::vector<double> past_kpa_;  ///< all commands since the start at rest
};

}  // namespace softgrip::control
