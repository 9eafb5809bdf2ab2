#pragma once
// How far the estimates can be trusted when the residuals are correlated.
//
// Least squares stays unbiased under correlated noise, but its usual intervals are far too short. Here the
// covariance is the sandwich (J'J)^-1 J' C J (J'J)^-1 with C from an autoregressive model of the residuals.

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/residuals.h"
#include "sysid/identification/noise_model.h"

namespace softgrip::sysid {

/// A direction in which the parameters may move together without the data objecting.
struct LooseDirection {
  std::vector<std::string> names;  ///< of the parameters that take part, the strongest first
  std::vector<double> weights;     ///< of them, in the fit's scale
  double deviation = 0;            ///< how far, in the fit's scale
};

/// The covariance of the estimates in the coordinates of the fit.
struct Uncertainty {
  Eigen::MatrixXd covariance;  ///< of z; zero rows where a parameter stands at a bound or has no effect
  Eigen::MatrixXd naive;       ///< the same if the noise were white
  std::vector<bool> at_bound;
  std::vector<bool> without_effect;
  NoiseModel noise;
  double quantile = 1.96;  ///< of Student's t for 95 %, by the effective number of samples
  std::vector<LooseDirection> loose;
};

/// At a minimum. @param huber_mm  as in the minimisation.
[[nodiscard]] Uncertainty uncertainty_at(const Residuals& residuals, const std::vector<double>& z,
                                         double huber_mm);

}  // namespace softgrip::sysid
