#pragma once
// Wrong samples, isolated or far from all others: found without a model, hidden from every other fit.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// What was found. `share` of the readings lie `size_mm` (root mean square) beside their neighbours.
struct OutlierEvidence {
  std::size_t count = 0;
  std::size_t readings = 0;  ///< with those that were hidden
  double share = 0;
  double size_mm = 0;
  double excess_mm = 0;  ///< what they add to the root mean square error of all readings
  double share_low = 0;  ///< 95 % interval of the share (Wilson)
  double share_high = 0;
  double size_low_mm = 0;  ///< 95 % interval of the size
  double size_high_mm = 0;
  bool distorts = false;  ///< they add more than a quarter of the noise to the error
  bool present = false;   ///< they distort, and are more than noise or a knock would give
  std::vector<double> sizes_mm;
};

/// Finds readings that differ from both neighbours' line by more than noise can and hides them (NaN). Before
/// any model is fitted: what a motion might hide, or make, is let pass. Sensor codes
/// (sysid/logs/sensor_codes.h) are hidden at any place, and so is one of the first or last 2 readings
/// that is far outside of all others and of 0.
[[nodiscard]] OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm);

/// The same with a fitted model, by what it leaves of the readings: finds those in the midst of a motion too.
/// A reading is one when its residual stands alone (its neighbours' residuals agree with each other) and no
/// shift by a sample and a half of what the model predicts would bring it about. Adds to `evidence`.
/// @param residual_mm  of these records: reading minus prediction, NaN where there is no reading.
/// @returns how many were hidden.
std::size_t hide_outliers_beside(std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                 OutlierEvidence& evidence);

}  // namespace softgrip::sysid
