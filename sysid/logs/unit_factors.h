#pragma once
// Detection of wrong units by the ratios of units.

#include <string>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// Returns "psi and kPa" if the factor, or its inverse, is the ratio of these units of pressure; "" if it is
/// not the ratio of two known units.
[[nodiscard]] std::string pressure_units_apart(double factor);

/// Returns the probable mistake if readings are `factor` times the expected values: "psi in a pressure column
/// taken for kPa (a factor of 6.895)"; "" if the factor is not the ratio of two units. The factor must be
/// above 0; `unit` is the unit of the readings.
[[nodiscard]] std::string mistaken_unit(double factor, model::OutputUnit unit);

}  // namespace softgrip::sysid
