#pragma once
// Intervals by profile likelihood: one parameter is moved while all others are fitted again.

#include <functional>
#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// Fills profile95 of every free model parameter of `estimates`, in the order of parameter_estimates(). The
/// threshold on the sum of squares is that of a likelihood ratio. It is widened by the factor by which the
/// correlation of the residuals increases the variance of the parameter.
void add_profiles(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& uncertainty,
                  double huber_mm, unsigned threads, std::vector<Estimate>& estimates);

}  // namespace softgrip::sysid
