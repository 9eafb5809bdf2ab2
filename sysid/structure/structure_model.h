#pragma once
// Conversion of a fitted structure into a model of blocks, which the daemon and all predictions use.

#include "sysid/fitting/fit_space.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// Returns the model and the estimated start states of the records. Operators with weight 0 are omitted. A
/// creep branch is kept if the unsettled creep of a record needs its time constant.
/// @param drive  Drive::measured: the lag is after the pressure sensor, in the finger.
[[nodiscard]] FitPoint point_of(const FittedStructure& fit, const std::vector<Record>& records, Drive drive);

}  // namespace softgrip::sysid
