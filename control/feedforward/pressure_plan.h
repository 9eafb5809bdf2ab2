#pragma once
// Defines a command over time that is computed before the run (control/sequences/planner.h). The control loop
// reads it in each tick.

#include <vector>

#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "model/model.h"

namespace softgrip::control {

/// A command over time, linear between its points. Its times are those of a finger without dead time: a value
/// must reach the valve one dead time before its time. The members are plain values; at() allocates no
/// memory.
struct PressurePlan {
  double start_s = 0;  ///< time of the first point on the reference's clock
  double step_s = 0;   ///< time between points
  std::vector<double> pressure_kpa;
  std::vector<double> displacement_mm;  ///< displacement of the model at the same times
  Reference reference;                  ///< the reference that was planned
  double begin_s = 0;                   ///< start of the step with this reference, on the plan's clock
  double rmse_mm = 0;                   ///< root mean square difference between model and reference
  double worst_mm = 0;                  ///< largest difference between model and reference

  [[nodiscard]] bool empty() const noexcept { return pressure_kpa.empty(); }
  /// Returns the command [kPa]; outside the plan its first or last value; 0 for an empty plan.
  [[nodiscard]] double at(double time_s) const noexcept;
  /// Returns the difference between model and reference [mm], constant outside the plan; 0 for an empty plan.
  [[nodiscard]] double miss_mm(double time_s) const noexcept;
};

/// The settled response of a model as a straight line between the lowest and the highest command.
struct SettledLine {
  double lowest_kpa = 0;
  double at_lowest_mm = 0;
  double gain_mm_per_kpa = 0;  ///< must be above 0 for planning
  [[nodiscard]] double pressure_kpa(double displacement_mm) const noexcept {
    return lowest_kpa + (displacement_mm - at_lowest_mm) / gain_mm_per_kpa;
  }
};
[[nodiscard]] SettledLine settled_line(const model::Model& model, const LimitSettings& limits);

/// Returns the model without dead times, dead bands, blocks of the sensor and blocks that are only noise.
[[nodiscard]] model::Model without_dead_time(const model::Model& model);

/// Time before a change of the reference at which a plan should start, so that an inverse response is over at
/// the change [s].
inline constexpr double plan_lead_s = 0.6;

}  // namespace softgrip::control
