#pragma once
// Computes estimates with intervals from a minimum and its covariance.

#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A minimum and its uncertainty.
struct FittedPoint {
  const Residuals& residuals;
  const std::vector<double>& z;
  const Uncertainty& uncertainty;
};

/// Returns every parameter of the model, fitted or fixed.
[[nodiscard]] std::vector<Estimate> parameter_estimates(const FittedPoint& fit);
/// Marks alpha and k0 as not identifiable, because only their sum alpha + 1/k0 is. Removes their intervals.
void name_the_sum(std::vector<Estimate>& parameters);
/// Returns the fitted start states.
[[nodiscard]] std::vector<Estimate> start_estimates(const FittedPoint& fit);
/// Returns combinations of parameters. Intervals follow from linear propagation, of the logarithm for
/// positive values.
[[nodiscard]] std::vector<Estimate> combination_estimates(const FittedPoint& fit);

}  // namespace softgrip::sysid
