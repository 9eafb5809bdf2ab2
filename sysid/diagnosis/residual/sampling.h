#pragma once
// Finds repeated readings, which occur if the sensor is slower than the log or frozen, and hides them from
// every fit.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct SamplingEvidence {
  double interval_s = 0;  ///< median time between new readings; 0: each sample is a new reading
  double frozen_s = 0;    ///< total time in which the reading is frozen while the drive moves
  /// Root mean square, over all readings, of the distance between repeated readings and a line through the
  /// new readings.
  double excess_mm = 0;
  std::size_t hidden = 0, readings = 0;
  bool present = false;  ///< true: `excess_mm` is more than a quarter of the noise
};

/// Replaces repeated readings by NaN if `present` becomes true.
///
/// A sensor counts as slower than its log under two conditions. At most one reading in ten changes again
/// after fewer than 2 samples. The changes also differ in size, whereas a sensor with a coarse resolution
/// changes by one step at a time. The first reading of each sensor interval is kept.
///
/// An interval of equal readings counts as frozen if it is 5 times as long as 95 % of all intervals and the
/// drive moves by a tenth of its range during it. Its value must not be the lowest or highest of the log,
/// because such an interval may be a saturation.
[[nodiscard]] SamplingEvidence hide_repeated(std::vector<Record>& records);

}  // namespace softgrip::sysid
