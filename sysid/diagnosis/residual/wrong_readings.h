#pragma once
// Removes wrong readings from logs, so that they do not affect fits and their errors.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Replaces the readings that hide_outliers() finds by NaN, unless they add less than a quarter of the noise
/// to the error. Returns a sentence for each log with removed readings that states their number and the first
/// of them.
[[nodiscard]] std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs);

}  // namespace softgrip::sysid
