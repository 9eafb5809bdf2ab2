#pragma once
// Finds repeated readings and excludes them from every fit. Readings are repeated if the sensor is slower
// than the log, or if the reading is frozen.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct SamplingEvidence {
  double interval_s = 0;  ///< median time between new readings; 0: no sensor counts as slower than its log
  double frozen_s = 0;    ///< total time during which the reading is frozen although the drive changes
  /// Root mean square error of all readings that the repetitions cause. The error of a repeated reading is
  /// its distance from a line through the new readings.
  double excess_mm = 0;
  std::size_t hidden = 0, readings = 0;
  bool present = false;  ///< true: `excess_mm` exceeds a quarter of the noise
  double step_mm = 0;    ///< size of the steps of the readings if the sensor is coarse, otherwise 0
};

/// Replaces repeated readings by NaN if `present` becomes true. Sets Record::step_mm and
/// SamplingEvidence::step_mm (coarse_step_mm()).
///
/// A sensor counts as slower than its log under three conditions. The log contains at least
/// limits::fewest_events complete intervals of equal readings. At most one in ten of these intervals contains
/// only one sample. The changes between the intervals differ in size; the changes of a sensor with a coarse
/// resolution are all equal to one step. In the log of such a sensor, the first reading of each interval of
/// equal readings is kept. In an interval that is longer than the median interval, one reading per median
/// interval is kept.
///
/// The reading counts as frozen in an interval of equal readings under three conditions; only the first
/// reading of such an interval is kept. The interval is at least 5 times as long as the 95 % quantile of all
/// such intervals. The drive moves in this interval by at least a tenth of its range. The reading is not the
/// lowest or highest reading of the log, because such a reading may be due to saturation. If the reading is
/// frozen in one interval, and consecutive readings of a log are usually unequal, the reading also counts as
/// frozen in the other intervals of this length in which the drive does not move.
[[nodiscard]] SamplingEvidence hide_repeated(std::vector<Record>& records);

/// Adds the error by rounding to the evidence if the sensor is coarse.
void add_rounding(SamplingEvidence& evidence);

}  // namespace softgrip::sysid
