#pragma once
// A command that was planned before the run, as the tick reads it; control/sequences/planner.h makes it.

#include <vector>

#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "model/model.h"

namespace softgrip::control {

/// A command over time, linear between its points. Its clock is that of the finger without dead time: a value
/// must reach the valve one dead time earlier. Plain values; at() allocates nothing.
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

/// The model without its dead times and dead bands, without what its sensor adds and without what is only
/// noise.
[[nodiscard]] model::Model without_dead_time(const model::Model& model);

/// Time by which a plan should start before a change of the reference, so that an inverse response is over by
/// then [s].
inline constexpr double plan_lead_s = 0.6;

}  // namespace softgrip::control
