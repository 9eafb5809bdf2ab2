#pragma once
// Size of a change as a quantity that a technician can check.

#include "sysid/changes/change.h"

namespace softgrip::sysid {

/// Returns the mean of a series over the bins whose drive is above 90 % of the largest drive.
[[nodiscard]] double at_full_pressure(const LaterReadings& readings, const Binned& added);

/// Returns the size.
/// @param full_pressure_mm  change of the displacement at full pressure.
[[nodiscard]] ChangeSize size_of(const LaterReadings& readings, const FittedEffect& effect,
                                 double full_pressure_mm);

}  // namespace softgrip::sysid
