#pragma once
// Detects wrong units. If a unit is wrong, two values that should be equal differ by the ratio of two units.

#include <string>

#include "model/output_unit.h"

namespace softgrip::sysid {

/// Returns the two units of pressure whose ratio is `factor` or its inverse, such as "psi and kPa". Returns
/// "" if `factor` is not the ratio of two known units.
[[nodiscard]] std::string pressure_units_apart(double factor);

/// Returns the probable mistake if the readings are `factor` times the expected values: "a pressure column
/// in psi was read as kPa (a factor of 6.895)". Returns "" if `factor` is not the ratio of two units.
/// @param factor  above 0.
/// @param unit  unit of the readings.
[[nodiscard]] std::string mistaken_unit(double factor, model::OutputUnit unit);

/// Limits for the largest pressure and for the range of the readings. A value below its limit probably has a
/// unit other than kPa, mm or deg. A soft finger moves by about 10 mm at 20 to 60 kPa and bends by more than
/// 3 deg. A bending angle in rad never exceeds 3.
inline constexpr double small_pressure_kpa = 2;
[[nodiscard]] constexpr double small_reading(model::OutputUnit unit) {
  return unit == model::OutputUnit::deg ? 3 : 0.1;
}

}  // namespace softgrip::sysid
