#pragma once
// Defines a command over time that is computed before the sequence starts (control/sequences/planner.h). The
// control loop reads the command of each tick from the plan.

#include <vector>

#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "model/model.h"

namespace softgrip::control {

/// A command over time, linear between its points. The times of the plan are for a finger without dead time.
/// A value must therefore reach the valve one dead time before its time in the plan. The members are plain
/// values; at() allocates no memory.
struct PressurePlan {
  double start_s = 0;  ///< time of the first point on the reference's clock
  double step_s = 0;   ///< time between two points of the plan
  std::vector<double> pressure_kpa;
  std::vector<double> displacement_mm;  ///< displacement of the model at the times of the points
  Reference reference;                  ///< reference for which the plan was computed
  double begin_s = 0;                   ///< time on the plan's clock at which the step with this reference
                                        ///< starts
  double rmse_mm = 0;                   ///< root mean square of the difference between model and reference
  double worst_mm = 0;                  ///< largest difference between model and reference

  [[nodiscard]] bool empty() const noexcept { return pressure_kpa.empty(); }
  /// Returns the command at a time [kPa]. Outside the plan, returns its first or last value; for an empty
  /// plan, 0.
  [[nodiscard]] double at(double time_s) const noexcept;
  /// Returns the difference between model and reference at a time [mm]. Outside the plan, returns the first
  /// or last difference; for an empty plan, 0.
  [[nodiscard]] double miss_mm(double time_s) const noexcept;
};

/// The settled displacement of a model over the command, as a straight line between the lowest and the
/// highest command.
struct SettledLine {
  double lowest_kpa = 0;
  double at_lowest_mm = 0;
  double gain_mm_per_kpa = 0;  ///< slope of the line; planning requires that it is above 0
  [[nodiscard]] double pressure_kpa(double displacement_mm) const noexcept {
    return lowest_kpa + (displacement_mm - at_lowest_mm) / gain_mm_per_kpa;
  }
};
[[nodiscard]] SettledLine settled_line(const model::Model& model, const LimitSettings& limits);

/// Returns the model without dead times, dead bands, blocks of the sensor and blocks that are only noise.
[[nodiscard]] model::Model without_dead_time(const model::Model& model);

/// Time by which a plan should start before its reference changes, so that an inverse response is over when
/// the reference changes [s].
inline constexpr double plan_lead_s = 0.6;

}  // namespace softgrip::control
