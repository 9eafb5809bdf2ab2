#pragma once
// From a minimum and its covariance to estimates with intervals.

#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A minimum as the functions below need it.
struct FittedPoint {
  const Residuals& residuals;
  const std::vector<double>& z;
  const Uncertainty& uncertainty;
};

/// Every parameter of the fitted model, free or not.
[[nodiscard]] std::vector<Estimate> parameter_estimates(const FittedPoint& fit);
/// Says of alpha and k0 that only their sum alpha + 1/k0 is identifiable, and takes their intervals away.
void name_the_sum(std::vector<Estimate>& parameters);
/// The free start states.
[[nodiscard]] std::vector<Estimate> start_estimates(const FittedPoint& fit);
/// Combinations of parameters, by linear propagation (of the logarithm where they are positive).
[[nodiscard]] std::vector<Estimate> combination_estimates(const FittedPoint& fit);

}  // namespace softgrip::sysid
