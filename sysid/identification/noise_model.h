#pragma once
// Models the correlation of the residuals of a fit by an autoregressive process.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// e_t = a_1 e_(t-1) + ... + a_p e_(t-p) + innovation.
struct NoiseModel {
  std::vector<double> coefficients;  ///< a_1 ... a_p; empty: white noise
  double innovation_mm = 0;          ///< standard deviation of the innovation
  double deviation_mm = 0;           ///< standard deviation of e itself
  double lag1_correlation = 0;
  /// Number of white samples that would determine a constant with the same accuracy.
  double effective_samples = 0;
};

/// Pooled autocovariances of several series, up to a lag of `most_lags` or a tenth of all samples. Values
/// that are not finite are gaps. Sums are divided by the number of all samples, not of pairs, so that the
/// result is a valid covariance.
struct Autocovariance {
  std::vector<double> lags;  ///< [mm^2], by lag from 0
  std::size_t samples = 0;
};
[[nodiscard]] Autocovariance autocovariance_of(const std::vector<std::span<const double>>& series,
                                               int most_lags = 40);

/// Returns the process with these autocovariances by the Yule-Walker equations. Akaike's criterion selects
/// the order.
[[nodiscard]] NoiseModel fit_noise(const Autocovariance& covariance);

}  // namespace softgrip::sysid
