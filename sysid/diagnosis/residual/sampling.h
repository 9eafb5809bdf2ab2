#pragma once
// Finds readings that repeat because the sensor is slower than the log, or because it is frozen. They are
// hidden from every fit.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct SamplingEvidence {
  double interval_s = 0;  ///< median time between new readings; 0: each sample is a new reading
  double frozen_s = 0;    ///< in total, while the reading is frozen and the drive moves
  /// Root mean square, over all readings, of the distance of repeated readings to a line through the new
  /// ones.
  double excess_mm = 0;
  std::size_t hidden = 0, readings = 0;
  bool present = false;  ///< the excess is more than a quarter of the noise
};

/// Hides readings that repeat (NaN), if that is `present`.
///
/// A log is slower than its samples if at most one change of the reading in ten comes sooner than 2 samples
/// after the change before, and the changes differ in size: a coarse sensor changes by one step at a time.
/// The first reading of each interval is kept. A stretch of equal readings is frozen if it is 5 times as long
/// as 95 % of all others, the drive moves by a tenth of its range meanwhile, and the value is not the lowest
/// or highest of the log (saturation).
[[nodiscard]] SamplingEvidence hide_repeated(std::vector<Record>& records);

}  // namespace softgrip::sysid
