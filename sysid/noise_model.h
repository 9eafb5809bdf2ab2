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

/// Fits the process to several series (not finite: a gap) of one kind: Yule-Walker's equations with pooled
/// autocovariances, the order by Akaike's criterion.
[[nodiscard]] NoiseModel fit_noise(const std::vector<std::span<const double>>& series, int most_lags = 40);

}  // namespace softgrip::sysid
