#pragma once
// Models the correlation of the residuals of a fit as an autoregressive process.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// The autoregressive process e_t = a_1 e_(t-1) + ... + a_p e_(t-p) + innovation.
struct NoiseModel {
  std::vector<double> coefficients;  ///< coefficients a_1 ... a_p; empty: the process is white noise
  double innovation_mm = 0;          ///< standard deviation of the innovation [mm]
  double deviation_mm = 0;           ///< standard deviation of the process e [mm]
  double lag1_correlation = 0;
  /// Number of uncorrelated samples whose mean would be as accurate as the mean of the correlated samples.
  double effective_samples = 0;
};

/// Common autocovariances of several series, up to a lag of `most_lags` or of a tenth of all samples. A value
/// that is not finite is a gap. For every lag, the sum of products is divided by the number of all samples,
/// not by the number of pairs. The result is therefore a valid covariance.
struct Autocovariance {
  std::vector<double> lags;  ///< autocovariance for each lag from 0 [mm^2]
  std::size_t samples = 0;
};
[[nodiscard]] Autocovariance autocovariance_of(const std::vector<std::span<const double>>& series,
                                               int most_lags = 40);

/// Returns the autoregressive process with these autocovariances (Yule-Walker equations). Akaike's criterion
/// selects the order of the process.
[[nodiscard]] NoiseModel fit_noise(const Autocovariance& covariance);

}  // namespace softgrip::sysid
