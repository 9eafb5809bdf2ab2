#pragma once
// Computes estimates of parameters and their intervals from the minimum of a fit and its covariance.

#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// The minimum of a fit, and the uncertainty of the parameters at this minimum.
struct FittedPoint {
  const Residuals& residuals;
  const std::vector<double>& z;
  const Uncertainty& uncertainty;
};

/// Returns the estimates of all parameters of the model, including the parameters that were not fitted.
[[nodiscard]] std::vector<Estimate> parameter_estimates(const FittedPoint& fit);
/// Marks alpha and k0 as not identifiable and removes their intervals. The data determine only their
/// combination alpha + 1/k0.
void name_the_sum(std::vector<Estimate>& parameters);
/// Returns the estimates of the fitted initial states of the logs.
[[nodiscard]] std::vector<Estimate> start_estimates(const FittedPoint& fit);
/// Returns the estimates of combinations of parameters. Their intervals are computed by linear error
/// propagation. If a combination is positive and has no typical value (Combination::scale is 0), the
/// propagation applies to its logarithm.
[[nodiscard]] std::vector<Estimate> combination_estimates(const FittedPoint& fit);

}  // namespace softgrip::sysid
