#pragma once
// Finds wrong readings without a model, so that no fit uses them. Wrong readings are isolated or far from all
// other readings.
// Removes wrong readings from logs, so that they affect neither fits nor the errors of fits.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Outliers that were found. `share` of the readings differ from their neighbours by `size_mm` (root mean
/// square).
struct OutlierEvidence {
  std::size_t count = 0;
  std::size_t readings = 0;  ///< number of all readings, including the hidden outliers
  double share = 0;
  double size_mm = 0;
  double excess_mm = 0;  ///< root mean square error of all readings that is due to the outliers
  double share_low = 0;  ///< lower end of the 95 % interval of the share (Wilson)
  double share_high = 0;
  double size_low_mm = 0;  ///< lower end of the 95 % interval of the size
  double size_high_mm = 0;
  bool distorts = false;  ///< true: the outliers increase the error by more than a quarter of the noise
  /// True: `distorts` is true, and the number of outliers is larger than noise or a knock on the table can
  /// cause.
  bool present = false;
  std::vector<double> sizes_mm;
};

/// Finds readings that differ from the median of their neighbours by more than the noise permits, and sets
/// these readings to NaN. The search runs before any model is fitted, so readings that a motion may explain
/// are kept. Sensor codes (sysid/logs/sensor_codes.h) are always hidden. The first 2 and the last 2 readings
/// are hidden if they are far from 0 and from all other readings.
[[nodiscard]] OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm);

/// Finds outliers from the residuals of a fitted model, including outliers in a motion. A reading is an
/// outlier if two conditions are fulfilled. First, its residual differs from the residuals of its neighbours,
/// which agree with each other. Second, a shift of the prediction by 1.5 samples cannot explain the
/// difference. Adds the outliers to `evidence`.
/// @param residual_mm  reading minus prediction, one vector per record; NaN for samples without a reading.
/// @returns the number of hidden readings.
std::size_t hide_outliers_beside(std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                 OutlierEvidence& evidence);

/// Replaces the readings that hide_outliers() finds by NaN if they increase the error by at least a quarter
/// of the noise. Returns a sentence for each log with removed readings. The sentence states the number of
/// these readings and the first of them.
[[nodiscard]] std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs);

}  // namespace softgrip::sysid
