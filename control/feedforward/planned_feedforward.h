#pragma once
// A feedforward computed before the run: the command that makes the model follow a whole reference.

#include <cstddef>
#include <functional>
#include <stop_token>
#include <vector>

#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "model/model.h"

namespace softgrip::model {
template <class T>
class Chain;
}

namespace softgrip::control {

/// A command over time, straight between its points. Its clock is that of the finger without dead time: what
/// stands at a time must act on the valve one dead time earlier. Plain values; at() allocates nothing.
struct PressurePlan {
  double start_s = 0;  ///< of the first point, on the reference's clock
  double step_s = 0;   ///< from point to point
  std::vector<double> pressure_kpa;
  std::vector<double> displacement_mm;  ///< what the model then does, at the same times
  Reference reference;                  ///< what was planned for
  double begin_s = 0;                   ///< when, on the plan's clock, the step begins that follows it
  double rmse_mm = 0;                   ///< of the model against the reference
  double worst_mm = 0;                  ///< its largest miss

  [[nodiscard]] bool empty() const noexcept { return pressure_kpa.empty(); }
  /// The command, its first value before and its last value after the plan [kPa]; 0 of an empty plan.
  [[nodiscard]] double at(double time_s) const noexcept;
  /// How far the model is from the reference then [mm], both held beyond the ends; 0 of an empty plan.
  [[nodiscard]] double miss_mm(double time_s) const noexcept;
};

/// A model's settled answer, taken as a straight line between the lowest and the highest command.
struct SettledLine {
  double lowest_kpa = 0;
  double at_lowest_mm = 0;
  double gain_mm_per_kpa = 0;  ///< planning needs it above 0
  [[nodiscard]] double pressure_kpa(double displacement_mm) const noexcept {
    return lowest_kpa + (displacement_mm - at_lowest_mm) / gain_mm_per_kpa;
  }
};
[[nodiscard]] SettledLine settled_line(const model::Model& model, const LimitSettings& limits);

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
  /// Planner is the memory of a sequence. Asked to stop, it returns what it has.
  [[nodiscard]] PressurePlan plan(const Reference& reference, double from_s, double to_s,
                                  const std::stop_token& stop = {});

  /// Something else moves the finger for a while: `command_kpa` of the time since then, within the limits.
  void drive(const std::function<double(double time_s)>& command_kpa, double duration_s);

  /// The last command so far, and where it has brought the model.
  [[nodiscard]] double command_kpa() const noexcept;
  [[nodiscard]] double displacement_mm() const;

  /// How long before a change of the reference a plan should begin, so that what moves the wrong way first
  /// has moved by then [s].
  static constexpr double lead_s = 0.6;

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
