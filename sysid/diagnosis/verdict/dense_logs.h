#pragma once
// Averages logs with far more samples than a finger needs. The time of a diagnosis grows with the number of
// readings. Their information does not grow if many of them lie within the response time of a finger.

#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Readings that are closer together are averaged over at most this time [s]: half a sample at 100 Hz.
inline constexpr double averaged_interval_s = 0.005;

/// Averages the records of a campaign with more than enough_readings (`sysid/logs/resampled_record.h`), and
/// adds one sentence per averaged record to `warnings`. Returns true if any record was averaged.
bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
