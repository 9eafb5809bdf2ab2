#pragma once
// Computes the pressure that a finger without contact needs for a displacement. The difference between the
// command and this pressure is the gripping pressure.
// Computes the displacements and the speed that a finger without contact reaches within the limits of its
// channel. The results are compared with the limits in the rig file.

#include <vector>

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

/// Displacement over command of a model's free finger, on the first motion away from rest. Each displacement
/// is taken 3 s after a jump of the command, when only slow creep remains. The inverse of the curve gives the
/// command for a displacement. Beyond its ends, the curve continues with its mean slope. The constructor
/// simulates a few thousand steps. The other functions allocate no memory.
class FreeCurve {
 public:
  FreeCurve(const model::Model& model, const LimitSettings& limits);

  /// Returns the command under which the free finger rests at `displacement_mm` [kPa]. `displacement_mm` is
  /// the displacement of the model without an offset.
  [[nodiscard]] double command_kpa(double displacement_mm) const noexcept {
    return at(command_kpa_, displacement_mm);
  }
  /// Returns the pressure at the actuator, after the valve, when the free finger rests at `displacement_mm`
  /// [kPa].
  [[nodiscard]] double pressure_kpa(double displacement_mm) const noexcept {
    return at(pressure_kpa_, displacement_mm);
  }
  /// Returns the smallest gripping pressure that causes a displacement shortfall of `shortfall_mm` at every
  /// position of the curve [kPa].
  [[nodiscard]] double squeeze_for_kpa(double shortfall_mm) const noexcept;

 private:
  [[nodiscard]] double at(const std::vector<double>& table, double displacement_mm) const noexcept;

  double lowest_mm_ = 0;
  double step_mm_ = 0;  ///< distance between two points of the curve; 0: the model does not move, so the
                        ///< curve has only one point
  double slope_kpa_per_mm_ = 0;
  std::vector<double> command_kpa_;  ///< commands for displacements that start at lowest_mm_ and increase by
                                     ///< step_mm_
  std::vector<double> pressure_kpa_;
};

struct FreeMotion {
  double rest_mm = 0;           ///< displacement of the finger at rest under the rest pressure
  double lowest_mm = 0;         ///< displacement 3 s after the command has reached the lowest pressure
  double highest_mm = 0;        ///< displacement 3 s after the command has reached the highest pressure
  double fastest_mm_per_s = 0;  ///< largest speed, upward or downward, within the slew limits
};

/// Simulates the model through the complete pressure range and back, in a few thousand steps. The simulation
/// leaves out noise and dead times.
[[nodiscard]] FreeMotion free_motion(const model::Model& model, const LimitSettings& limits);

}  // namespace softgrip::control
