#pragma once
// Logs with far more samples than a finger needs. The time of a diagnosis grows with the readings; what they
// tell does not where many of them lie within the time in which a finger moves at all.

#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Campaigns of fewer readings are left alone.
inline constexpr std::size_t most_readings = 40'000;
/// What of a larger one lies closer together is averaged, up to this [s]: half a sample of a rig at 100 Hz.
inline constexpr double averaged_interval_s = 0.005;

/// Averages the records of such a campaign, and adds to `warnings` one sentence for each that was. Returns
/// whether any was.
bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
