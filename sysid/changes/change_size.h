#pragma once
// How large a change is, in what a technician checks.

#include "sysid/changes/change.h"

namespace softgrip::sysid {

/// The mean of a series over the bins whose drive is within a tenth of the largest of the records.
[[nodiscard]] double at_full_pressure(const LaterReadings& readings, const Binned& added);

/// @param full_pressure_mm  what the effect does at the highest pressures.
[[nodiscard]] ChangeSize size_of(const LaterReadings& readings, const FittedEffect& effect,
                                 double full_pressure_mm);

}  // namespace softgrip::sysid
