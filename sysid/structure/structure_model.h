#pragma once
// Converts a fitted structure into a model that consists of blocks. The daemon and all predictions use models
// of this type.

#include "sysid/fitting/fit_space.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// Returns the model and the estimated start states of the records. Operators with weight 0 are omitted.
/// Exception: a creep branch stays in the model if the unsettled creep of a record needs its time constant.
/// @param drive  input of the model. With Drive::measured, the lag belongs to the finger and comes after the
/// pressure sensor.
[[nodiscard]] FitPoint point_of(const FittedStructure& fit, const std::vector<Record>& records, Drive drive);

}  // namespace softgrip::sysid
