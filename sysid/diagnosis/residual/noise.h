#pragma once
// The readings' noise, measured from the data alone, and whether a residual is more than that noise.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Standard deviation of what changes from sample to sample without order [mm], by third differences: smooth
/// motion does not count, quantisation does, single wrong samples do not.
[[nodiscard]] double measured_noise_mm(const std::vector<Record>& records);

/// What is left in a residual beyond the noise.
struct Structure {
  double excess_mm = 0;         ///< root of mean square minus noise squared, 0 where that is negative
  double slow_correlation = 0;  ///< mean autocorrelation over the first lags (about a quarter of a second)
  bool present = false;         ///< the residual is not just noise
};

/// @param residual_mm  by record; NaN where there is no reading.
[[nodiscard]] Structure structure_of(const std::vector<std::vector<double>>& residual_mm, double noise_mm);

}  // namespace softgrip::sysid
