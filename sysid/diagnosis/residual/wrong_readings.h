#pragma once
// Removes wrong readings from logs before they affect a fit and its errors.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Replaces the readings that hide_outliers() finds by NaN. Readings that add less than a quarter of the
/// noise to the error are kept. Returns a sentence for each log with removed readings: their number and the
/// first of them.
[[nodiscard]] std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs);

}  // namespace softgrip::sysid
