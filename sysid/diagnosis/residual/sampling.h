#pragma once
// Finds readings that repeat because the sensor is slower than the log, or because it is frozen. They are
// hidden from every fit.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct SamplingEvidence {
  double interval_s = 0;  ///< median time between new readings; 0: each sample is a new reading
  double frozen_s = 0;    ///< total time in which the reading is frozen while the drive moves
  /// Root mean square, over all readings, of the distance of repeated readings to a line through the new
  /// readings.
  double excess_mm = 0;
  std::size_t hidden = 0, readings = 0;
  bool present = false;  ///< the excess is more than a quarter of the noise
};

/// Replaces repeated readings by NaN if they are `present`.
///
/// A sensor is slower than its log under two conditions. At most one change of the reading in ten follows the
/// previous change after fewer than 2 samples. The changes differ in size, because a coarse sensor changes by
/// one step at a time. The first reading of each interval is kept.
///
/// An interval of equal readings is frozen if it is 5 times as long as 95 % of all others and the drive moves
/// by a tenth of its range in this time. Its value must not be the lowest or highest of the log (saturation).
[[nodiscard]] SamplingEvidence hide_repeated(std::vector<Record>& records);

}  // namespace softgrip::sysid
