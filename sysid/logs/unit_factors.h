#pragma once
// Factors that lie between two units: what gives a mistaken one away.

#include <string>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// "psi and kPa" where the factor, or its inverse, lies between these units of pressure; "" where none does.
[[nodiscard]] std::string pressure_units_apart(double factor);

/// What was probably mistaken where readings are `factor` times what they should be: "psi in a pressure
/// column taken for kPa (a factor of 6.895)"; "" where the factor is no unit's. The factor is above 0,
/// `unit` that of the readings.
[[nodiscard]] std::string mistaken_unit(double factor, model::OutputUnit unit);

}  // namespace softgrip::sysid
