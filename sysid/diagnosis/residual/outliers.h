#pragma once
// Finds wrong samples without a model: samples that are isolated or far from all others. They are hidden from
// every fit.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Detected outliers. `share` of the readings differ by `size_mm` (root mean square) from their neighbours.
struct OutlierEvidence {
  std::size_t count = 0;
  std::size_t readings = 0;  ///< number of readings, including hidden ones
  double share = 0;
  double size_mm = 0;
  double excess_mm = 0;  ///< contribution of the outliers to the root mean square error of all readings
  double share_low = 0;  ///< 95 % interval of the share (Wilson)
  double share_high = 0;
  double size_low_mm = 0;  ///< 95 % interval of the size
  double size_high_mm = 0;
  bool distorts = false;  ///< true: the outliers add more than a quarter of the noise to the error
  bool present = false;   ///< true: the outliers distort and are too many for noise or a knock on the table
  std::vector<double> sizes_mm;
};

/// Finds readings that differ from the median of their neighbours by more than the noise permits, and hides
/// them (sets them to NaN). The test runs before any model is fitted, so it keeps readings that a motion may
/// explain. Sensor codes (sysid/logs/sensor_codes.h) are always hidden. The first 2 and the last 2 readings
/// are hidden if they are far from all others and from 0.
[[nodiscard]] OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm);

/// Finds outliers from the residuals of a fitted model, also during a motion. A reading is an outlier if its
/// residual differs from those of its neighbours, which agree with each other, and if a shift of the
/// prediction by 1.5 samples cannot explain the difference. Adds the outliers to `evidence`.
/// @param residual_mm  reading minus prediction, one vector per record; NaN for samples without a reading.
/// @returns the number of hidden readings.
std::size_t hide_outliers_beside(std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                 OutlierEvidence& evidence);

}  // namespace softgrip::sysid
