#pragma once
// Computes estimates with intervals from the minimum of a fit and its covariance.

#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// The minimum of a fit and its uncertainty.
struct FittedPoint {
  const Residuals& residuals;
  const std::vector<double>& z;
  const Uncertainty& uncertainty;
};

/// Returns the estimates of all parameters of the model, including the fixed ones.
[[nodiscard]] std::vector<Estimate> parameter_estimates(const FittedPoint& fit);
/// Marks alpha and k0 as not identifiable and removes their intervals, because the data determine only the
/// sum alpha + 1/k0.
void name_the_sum(std::vector<Estimate>& parameters);
/// Returns the fitted initial states.
[[nodiscard]] std::vector<Estimate> start_estimates(const FittedPoint& fit);
/// Returns combinations of parameters. Their intervals follow from linear error propagation, applied to the
/// logarithm if the value is positive.
[[nodiscard]] std::vector<Estimate> combination_estimates(const FittedPoint& fit);

}  // namespace softgrip::sysid
