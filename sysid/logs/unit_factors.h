#pragma once
// Factors that lie between two units: what gives a mistaken one away.

#include <string>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// "psi and kPa" where the factor, or its inverse, lies between these units of pressure; "" where none does.
[[nodiscard]] std::string pressure_units_apart(double factor);

/// Returns the probable mistake if readings are `factor` times the expected values: "psi in a pressure column
/// taken for kPa (a factor of 6.895)"; "" if the factor is that of no unit. The factor is above 0,
/// `unit` that of the readings.
[[nodiscard]] std::string mistaken_unit(double factor, model::OutputUnit unit);

}  // namespace softgrip::sysid
