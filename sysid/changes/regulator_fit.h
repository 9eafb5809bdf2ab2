#pragma once
// Which regulator stands between a command and what was read.

#include <vector>

#include "sysid/changes/regulator.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// What reads a regulator's pressure.
enum class ReadBy {
  gauge,   ///< the pressure itself, but for its gain and zero
  finger,  ///< what a bank of plays and lags makes of it, all its weights fitted anew for every regulator
};

/// The regulator behind which least is left of the readings.
/// @param records  driven by the command.
[[nodiscard]] Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa,
                                      ReadBy read_by = ReadBy::finger);

}  // namespace softgrip::sysid
