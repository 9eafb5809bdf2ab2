#pragma once
// Estimates the regulator between a command and a reading.

#include <vector>

#include "sysid/changes/regulator.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The sensor behind a regulator.
enum class ReadBy {
  gauge,   ///< the pressure, except for gain and zero
  finger,  ///< a bank of plays and lags, whose weights are fitted again for each regulator
};

/// Returns the regulator with the smallest residual of the readings.
/// @param records  driven by the command.
[[nodiscard]] Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa,
                                      ReadBy read_by = ReadBy::finger);

}  // namespace softgrip::sysid
