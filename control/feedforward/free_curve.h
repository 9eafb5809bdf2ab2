#pragma once
// Computes the pressure that a free finger needs at a displacement. The pressure above it is gripping
// pressure.

#include <vector>

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

/// Where the free finger of a model comes to rest under a command, the first time away from rest: the
/// displacement three seconds after a jump to it, when all but slow creep is over. Read the other way round
/// it says which command a displacement needs. Beyond its ends it goes on with its mean slope. Construction
/// steps the model a few thousand times; reading allocates nothing.
class FreeCurve {
 public:
  FreeCurve(const model::Model& model, const LimitSettings& limits);

  /// The command under which the free finger rests at `displacement_mm` (the model's, without offset) [kPa].
  [[nodiscard]] double command_kpa(double displacement_mm) const noexcept {
    return at(command_kpa_, displacement_mm);
  }
  /// The pressure at the actuator then, behind the valve [kPa].
  [[nodiscard]] double pressure_kpa(double displacement_mm) const noexcept {
    return at(pressure_kpa_, displacement_mm);
  }
  /// Returns the smallest gripping pressure that causes a displacement shortfall of `shortfall_mm` at every
  /// position of the curve [kPa].
  [[nodiscard]] double squeeze_for_kpa(double shortfall_mm) const noexcept;

 private:
  [[nodiscard]] double at(const std::vector<double>& table, double displacement_mm) const noexcept;

  double lowest_mm_ = 0;
  double step_mm_ = 0;  ///< 0: the model does not move; everything is where it begins
  double slope_kpa_per_mm_ = 0;
  std::vector<double> command_kpa_;  ///< from lowest_mm_ on, step_mm_ apart
  std::vector<double> pressure_kpa_;
};

}  // namespace softgrip::control
