#pragma once
// Measures the noise of the readings from the data alone, and tests a residual against it.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the standard deviation of the random changes from sample to sample [mm], from third differences.
/// Smooth motion and single wrong samples do not contribute; quantisation does.
[[nodiscard]] double measured_noise_mm(const std::vector<Record>& records);

/// Wrong readings that add less than this share of the noise to the error are not reported, because they may
/// be corners of a motion.
inline constexpr double distorting_share = 0.25;

/// The unexplained error: the part of a residual beyond the noise.
struct UnexplainedError {
  double excess_mm = 0;         ///< root of mean square minus noise squared; 0 if negative
  double slow_correlation = 0;  ///< mean autocorrelation over the first lags (about a quarter of a second)
  bool present = false;         ///< the residual is more than noise
};

/// @param residual_mm  by record; NaN where there is no reading.
[[nodiscard]] UnexplainedError unexplained_error_of(const std::vector<std::vector<double>>& residual_mm,
                                                    double noise_mm);

}  // namespace softgrip::sysid
