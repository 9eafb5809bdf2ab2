#pragma once
// Removes wrong readings from logs, so that they affect neither fits nor the errors of fits.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Replaces the readings that hide_outliers() finds by NaN if they increase the error by at least a quarter
/// of the noise. Returns a sentence for each log with removed readings. The sentence states the number of
/// these readings and the first of them.
[[nodiscard]] std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs);

}  // namespace softgrip::sysid
