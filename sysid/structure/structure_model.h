#pragma once
// Converts a fitted structure into a model of blocks, which the daemon and all predictions use.

#include "sysid/fitting/fit_space.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// Returns the model and the estimated start states of the records. Operators with weight 0 are omitted,
/// except for creep branches whose time constant the unsettled creep of a record needs.
/// @param drive  input of the model. With Drive::measured, the lag is a lag of the finger, after the pressure
/// sensor.
[[nodiscard]] FitPoint point_of(const FittedStructure& fit, const std::vector<Record>& records, Drive drive);

}  // namespace softgrip::sysid
