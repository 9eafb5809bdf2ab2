#pragma once
// Computes the covariance of the estimates for correlated residuals.
//
// Under correlated noise, a least-squares estimate is unbiased, but the usual intervals are far too short.
// Therefore the covariance is the sandwich (J'J)^-1 J' C J (J'J)^-1. J is the Jacobian of the residuals, and
// C is the covariance of the noise from an autoregressive model of the residuals.

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/residuals.h"
#include "sysid/identification/noise_model.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

/// A combination of parameters that can change with little effect on the error.
struct LooseDirection {
  /// Parameters of the combination; the one with the largest weight comes first.
  std::vector<std::string> names;
  std::vector<double> weights;  ///< weights of `names`, in the scale of the fit
  double deviation = 0;         ///< standard deviation of the combination in the scale of the fit
};

/// Covariance of the estimates in the coordinates z of the fit.
struct Uncertainty {
  Eigen::MatrixXd covariance;  ///< covariance of z; rows of parameters at a bound or without effect are zero
  Eigen::MatrixXd naive;       ///< covariance of z under the assumption of white noise
  std::vector<bool> at_bound;
  std::vector<bool> without_effect;
  NoiseModel noise;
  double quantile =
      limits::deviate;  ///< 95 % quantile of Student's t distribution for the effective number of samples
  std::vector<LooseDirection> loose;
};

/// Computes the uncertainty of the estimates at the minimum `z`.
/// @param huber_mm  width of Huber's loss in the minimisation; infinity: the loss is the squared error.
[[nodiscard]] Uncertainty uncertainty_at(const Residuals& residuals, const std::vector<double>& z,
                                         double huber_mm);

}  // namespace softgrip::sysid
