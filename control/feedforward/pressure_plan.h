#pragma once
// Defines a command over time that is computed before the sequence starts (control/sequences/planner.h). The
// control loop reads the command of each tick from the plan.

#include <vector>

#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "model/model.h"

namespace softgrip::control {

/// A command over time, linear between its points. The plan is computed for a finger without dead time.
/// Therefore, a command must reach the valve one dead time before its time in the plan. at() allocates no
/// memory.
struct PressurePlan {
  double start_s = 0;  ///< time of the first point on the reference's clock
  double step_s = 0;   ///< time between two points of the plan
  std::vector<double> pressure_kpa;
  std::vector<double> displacement_mm;  ///< displacement of the model at the times of the points
  Reference reference;                  ///< reference for which the plan was computed
  double begin_s = 0;                   ///< start of the sequence step to which the reference belongs, on the
                                        ///< clock of the plan
  double rmse_mm = 0;                   ///< root mean square of the difference between the model's
                                        ///< displacement and the reference
  double worst_mm = 0;                  ///< largest difference between the model's displacement and the
                                        ///< reference
  int iterations = 0;                   ///< iterations of the planner in all windows

  [[nodiscard]] bool empty() const noexcept { return pressure_kpa.empty(); }
  /// Returns the command at a time [kPa]. Before the plan, returns the first command; after the plan, the
  /// last command; for an empty plan, 0.
  [[nodiscard]] double at(double time_s) const noexcept;
  /// Returns the difference between the model's displacement and the reference at a time [mm]. Before the
  /// plan, returns the first difference; after the plan, the last difference; for an empty plan, 0.
  [[nodiscard]] double miss_mm(double time_s) const noexcept;
};

/// The settled displacement of a model over the command, as a straight line from the lowest to the highest
/// command.
struct SettledLine {
  double lowest_kpa = 0;
  double at_lowest_mm = 0;
  double gain_mm_per_kpa = 0;  ///< slope of the line; above 0 for every model that can be planned
  [[nodiscard]] double pressure_kpa(double displacement_mm) const noexcept {
    return lowest_kpa + (displacement_mm - at_lowest_mm) / gain_mm_per_kpa;
  }
};
[[nodiscard]] SettledLine settled_line(const model::Model& model, const LimitSettings& limits);

/// Returns the model without dead times, dead bands, sensor blocks and noise blocks.
[[nodiscard]] model::Model without_dead_time(const model::Model& model);

/// Time before a change of the reference at which the commands of a plan should start to change [s]. During
/// this time, an inverse response of the finger decays.
inline constexpr double plan_lead_s = 0.6;

}  // namespace softgrip::control
