#pragma once
// Computes a feedforward before the run: the command that makes the model follow a whole reference.

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
/// with y the response of the model without its dead time, which preview compensates, but with lag and
/// saturation. No inverse is needed, so models with an inverse response can be planned too: the plan acts
/// before the reference does, as far as its time allows.
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
  /// Planner is the memory of a sequence. Asked to stop, it returns what it has.
  [[nodiscard]] PressurePlan plan(const Reference& reference, double from_s, double to_s,
                                  const std::stop_token& stop = {});

  /// Something else moves the finger for a while: `command_kpa` of the time since then, within the limits.
  void drive(const std::function<double(double time_s)>& command_kpa, double duration_s);

  /// The last command so far, and where it has brought the model.
  [[nodiscard]] double command_kpa() const noexcept;
  [[nodiscard]] double displacement_mm() const;

 private:
  [[nodiscard]] model::Chain<double> finger() const;
  void add_point(double wanted_kpa, model::Chain<double>& chain, PressurePlan& plan);

  model::Model model_;  ///< without dead time
  LimitSettings limits_;
  double step_s_;
  SettledLine settled_;
  std::vector<double> past_kpa_;  ///< every command, from rest on
};

}  // namespace softgrip::control
