#pragma once
// Detects wrong units: two quantities then differ by the ratio of two units.

#include <string>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// Returns "psi and kPa" if the factor, or its inverse, is the ratio of these two units of pressure. Returns
/// "" if the factor is not the ratio of two known units.
[[nodiscard]] std::string pressure_units_apart(double factor);

/// Returns the probable mistake if the readings are `factor` times the expected values: "psi in a pressure
/// column taken for kPa (a factor of 6.895)". Returns "" if the factor is not the ratio of two units. The
/// factor must be above 0. `unit` is the unit of the readings.
[[nodiscard]] std::string mistaken_unit(double factor, model::OutputUnit unit);

}  // namespace softgrip::sysid
