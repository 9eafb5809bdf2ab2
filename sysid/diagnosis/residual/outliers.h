#pragma once
// Finds wrong samples, isolated or far from all others, without a model. They are hidden from every other
// fit.

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
  double excess_mm = 0;  ///< their contribution to the root mean square error of all readings
  double share_low = 0;  ///< 95 % interval of the share (Wilson)
  double share_high = 0;
  double size_low_mm = 0;  ///< 95 % interval of the size
  double size_high_mm = 0;
  bool distorts = false;  ///< they add more than a quarter of the noise to the error
  bool present = false;   ///< they distort, and exceed the effect of noise or a knock
  std::vector<double> sizes_mm;
};

/// Finds readings that differ from the line through both neighbours by more than the noise permits, and hides
/// them (NaN). It runs before any model is fitted. Therefore it keeps readings that a motion might hide or
/// cause. Sensor codes (sysid/logs/sensor_codes.h) are hidden everywhere. One of the first or last 2 readings
/// is hidden if it is far from all others and from 0.
[[nodiscard]] OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm);

/// Finds outliers from the residuals of a fitted model, also during a motion. A reading is an outlier if its
/// residual is isolated: its neighbours' residuals agree with each other. In addition, a shift of the model
/// prediction by 1.5 samples must not explain it. Adds to `evidence`.
/// @param residual_mm  of these records: reading minus prediction, NaN where there is no reading.
/// @returns the number of hidden readings.
std::size_t hide_outliers_beside(std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                 OutlierEvidence& evidence);

}  // namespace softgrip::sysid
