#pragma once
// Computes the covariance of the estimates for correlated residuals.
//
// Under correlated noise, a least-squares estimate is unbiased, but the usual intervals are far too short.
// Therefore the covariance is the sandwich (J'J)^-1 J' C J (J'J)^-1. J is the Jacobian of the residuals, and
// C is the covariance of the noise from an autoregressive model of the residuals.
// Models the correlation of the residuals of a fit as an autoregressive process.

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/residuals.h"
#include "sysid/limits/limits.h"

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

/// Common autocovariances of several series, up to a lag of 40 samples, but at most a tenth of all samples. A
/// value that is not finite is a gap. For every lag, the sum of products is divided by the number of all
/// samples, not by the number of pairs. The result is therefore a valid covariance.
struct Autocovariance {
  std::vector<double> lags;  ///< autocovariance for each lag from 0 [mm^2]
  std::size_t samples = 0;
};
[[nodiscard]] Autocovariance autocovariance_of(const std::vector<std::span<const double>>& series);

/// Returns the autoregressive process with these autocovariances (Yule-Walker equations). Akaike's criterion
/// selects the order of the process.
[[nodiscard]] NoiseModel fit_noise(const Autocovariance& covariance);

/// A combination of parameters that can change with little effect on the error.
struct LooseDirection {
  /// Parameters of the combination; the one with the largest weight comes first.
  std::vector<std::string> names;
  std::vector<double> weights;  ///< weights of `names`, in the scale of the fit
  double deviation = 0;         ///< standard deviation of the combination in the scale of the fit
};

/// Covariance of the estimates in the coordinates z of the fit.
struct Uncertainty {
  /// Square root of the covariance of z: the covariance is root * root'. Rows of parameters at a bound or
  /// without effect are zero. A direction that the data do not determine has a very large deviation.
  Eigen::MatrixXd root;
  Eigen::VectorXd white_variance;  ///< variance of each z under the assumption of white noise
  /// Standard deviation of each z if all other coordinates were known and the noise were white; 0: the
  /// parameter is without effect.
  Eigen::VectorXd lone_deviation;
  std::vector<bool> at_bound;
  /// True: a change of the parameter over its whole permitted range changes the residuals by a negligible
  /// share of the noise.
  std::vector<bool> without_effect;
  NoiseModel noise;
  double quantile = limits::deviate;  ///< half width of a 95 % interval in standard deviations: two-sided
                                      ///< quantile of Student's t distribution, with the effective number of
                                      ///< samples minus the number of parameters as degrees of freedom
  std::vector<LooseDirection> loose;

  /// Returns the standard deviation of coordinate `index`; 0: the parameter is at a bound or without effect.
  [[nodiscard]] double deviation(std::size_t index) const {
    return root.row(static_cast<Eigen::Index>(index)).norm();
  }
};

/// Computes the uncertainty of the estimates at the minimum `z`.
/// @param huber_mm  width of Huber's loss in the minimisation; infinity: the loss is the squared error.
[[nodiscard]] Uncertainty uncertainty_at(const Residuals& residuals, const std::vector<double>& z,
                                         double huber_mm);

}  // namespace softgrip::sysid
