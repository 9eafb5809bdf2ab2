#pragma once
// Detects wrong units. If a unit is wrong, two values that should be equal differ by the ratio of two units.

#include <string>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// Returns the two units of pressure whose ratio is `factor` or its inverse, such as "psi and kPa". Returns
/// "" if `factor` is not the ratio of two known units.
[[nodiscard]] std::string pressure_units_apart(double factor);

/// Returns the probable mistake if the readings are `factor` times the expected values: "psi in a pressure
/// column taken for kPa (a factor of 6.895)". Returns "" if `factor` is not the ratio of two units.
/// @param factor  above 0.
/// @param unit  unit of the readings.
[[nodiscard]] std::string mistaken_unit(double factor, model::OutputUnit unit);

}  // namespace softgrip::sysid
