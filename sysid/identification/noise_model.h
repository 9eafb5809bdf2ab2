#pragma once
// What a fit's residuals are correlated like: an autoregressive process.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// e_t = a_1 e_(t-1) + ... + a_p e_(t-p) + innovation.
struct NoiseModel {
  std::vector<double> coefficients;  ///< a_1 ... a_p; none: white
  double innovation_mm = 0;          ///< standard deviation of the innovation
  double deviation_mm = 0;           ///< standard deviation of e itself
  double lag1_correlation = 0;
  /// White samples that would tell as much about a constant as these do.
  double effective_samples = 0;
};

/// Autocovariances of several series (not finite: a gap) of one kind, pooled, up to a lag of `most_lags` or a
/// tenth of all samples. Divided by the count of all samples, not of pairs: that keeps them a covariance.
struct Autocovariance {
  std::vector<double> lags;  ///< [mm^2], by lag from 0
  std::size_t samples = 0;
};
[[nodiscard]] Autocovariance autocovariance_of(const std::vector<std::span<const double>>& series,
                                               int most_lags = 40);

/// The process with these autocovariances: Yule-Walker's equations, the order by Akaike's criterion.
[[nodiscard]] NoiseModel fit_noise(const Autocovariance& covariance);

}  // namespace softgrip::sysid
