#pragma once
// Averages logs that have far more samples than a diagnosis needs, because the computing time grows with the
// number of readings. Several readings within the response time of a finger contain no more information than
// their average.

#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Longest time over which neighbouring readings are averaged [s]: half a sample interval at 100 Hz.
inline constexpr double averaged_interval_s = 0.005;

/// Averages the records if they have more readings than enough_readings (`sysid/logs/resampled_record.h`),
/// and adds one sentence per averaged record to `warnings`. Returns true if any record was averaged.
bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
