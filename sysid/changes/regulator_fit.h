#pragma once
// Estimates the parameters of the regulator between a command and a recorded signal.

#include <vector>

#include "sysid/changes/regulator.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Signal that was recorded behind a regulator.
enum class ReadBy {
  gauge,  ///< the pressure; the gain and the zero offset of its sensor are fitted
  /// The displacement, described by a bank of plays and lags with weights that are refitted for each
  /// regulator.
  finger,
};

/// Returns the regulator that leaves the smallest residual of the readings.
/// @param records  records with the command as drive.
[[nodiscard]] Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa,
                                      ReadBy read_by = ReadBy::finger);

}  // namespace softgrip::sysid
