#pragma once
// Finds wrong readings, so that no fit uses them. Wrong readings are isolated, or they are far from all other
// readings.
// Removes wrong readings from logs before any fit, so that they do not affect the fits or the errors.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Outliers that were found. A share `share` of all readings are outliers. Their distance from their
/// neighbours is `size_mm` (root mean square).
struct OutlierEvidence {
  std::size_t count = 0;
  std::size_t readings = 0;  ///< number of all readings, including the hidden outliers
  double share = 0;
  double size_mm = 0;
  double excess_mm = 0;  ///< root mean square error of all readings that the outliers cause
  double share_low = 0;  ///< lower end of the 95 % interval of the share (Wilson)
  double share_high = 0;
  double size_low_mm = 0;  ///< lower end of the 95 % interval of the size
  double size_high_mm = 0;
  bool distorts = false;  ///< true: the outliers cause an error above a quarter of the noise
  /// True: the outliers cause an error above a quarter of the noise, and there are at least
  /// limits::fewest_occurrences of them.
  bool present = false;
  std::vector<double> sizes_mm;
};

/// Replaces outliers by NaN. An outlier differs from the median of its neighbours by more than the noise
/// permits. The search runs before any model is fitted, so it keeps every reading that a motion may explain.
/// Sensor codes (sysid/logs/sensor_codes.h) are always replaced. The first 2 and the last 2 readings are
/// replaced if they are far from 0 and from all other readings.
[[nodiscard]] OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm);

/// Finds outliers in the residuals of a fitted model. This function also finds outliers during a motion. Two
/// conditions define an outlier. First, its residual differs from the residuals of its neighbours, and the
/// neighbours agree with each other. Second, a shift of the prediction by 1.5 samples cannot explain the
/// difference. Replaces the outliers by NaN and adds them to `evidence`.
/// @param residual_mm  reading minus prediction, one vector per record; NaN for samples without a reading.
/// @returns the number of replaced readings.
std::size_t hide_outliers_beside(std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                 OutlierEvidence& evidence);

/// Replaces wrong readings by NaN if together they cause an RMS error above a quarter of the noise.
/// hide_outliers() determines which readings are wrong. Returns one sentence for each log with replaced
/// readings. The sentence states their number and the first ones of them.
[[nodiscard]] std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs);

}  // namespace softgrip::sysid
