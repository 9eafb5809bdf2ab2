#pragma once
// A fitted structure as a model of blocks, for the daemon and for everything that predicts.

#include "sysid/fitting/fit_space.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// The model and what the records' starts were found to be. Operators without weight are left out, but for
/// creep branches where a record's unsettled creep needs their time constants.
/// @param drive  Drive::measured: the lag stands behind the measuring point, in the finger.
[[nodiscard]] FitPoint point_of(const FittedStructure& fit, const std::vector<Record>& records, Drive drive);

}  // namespace softgrip::sysid
