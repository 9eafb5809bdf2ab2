#pragma once
// Computes intervals by profile likelihood: one parameter is changed in steps, and all other parameters are
// fitted at each step.

#include <functional>
#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// Computes profile95 of every fitted model parameter in `estimates`, which has the order of
/// parameter_estimates(). The threshold for the sum of squares is that of a likelihood-ratio test, multiplied
/// by a factor for the correlation of the residuals. This factor is the increase of the variance of the
/// parameter by the correlation.
void add_profiles(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& uncertainty,
                  double huber_mm, unsigned threads, std::vector<Estimate>& estimates);

}  // namespace softgrip::sysid
