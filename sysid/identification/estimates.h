#pragma once
// Computes estimates of parameters and their intervals from the minimum of a fit and its covariance.
// Computes intervals by profile likelihood: one parameter is changed in steps, and all other parameters are
// fitted at each step.

#include <functional>
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

/// Computes profile95 of every fitted model parameter in `estimates`, which has the order of
/// parameter_estimates(). The threshold for the sum of squares is the threshold of a likelihood-ratio test,
/// multiplied by a factor for the correlation of the residuals. The factor is the variance of the parameter
/// for correlated residuals, divided by its variance for white noise, but at least 1. For a parameter at a
/// bound, the factor is the number of residuals divided by their effective number. profile95 stays empty if
/// the search reaches neither the threshold nor the bound of the parameter.
void add_profiles(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& uncertainty,
                  double huber_mm, unsigned threads, std::vector<Estimate>& estimates);

}  // namespace softgrip::sysid
