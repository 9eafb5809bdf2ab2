#pragma once
// Estimates the parameters of the regulator between a command and a recorded signal.

#include <vector>

#include "sysid/changes/regulator.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Quantity that was recorded behind a regulator.
enum class ReadBy {
  gauge,  ///< the pressure; gain and zero offset of its sensor are fitted
  /// The displacement. It is described by a bank of plays and lags, whose weights are fitted for each
  /// regulator.
  finger,
};

/// Returns the regulator with the smallest sum of squared residuals.
/// @param records  records whose drive is the command.
[[nodiscard]] Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa,
                                      ReadBy read_by = ReadBy::finger);

}  // namespace softgrip::sysid
