#pragma once
// Intervals by profile likelihood: how far a parameter can go while all others follow.

#include <functional>
#include <vector>

#include "sysid/fitting/residuals.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// For every free model parameter of `estimates` (as parameter_estimates() orders them) fills profile95. The
/// threshold on the sum of squares is that of a likelihood ratio, widened by how much the correlation of
/// the residuals widens the parameter's variance.
void add_profiles(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& uncertainty,
                  double huber_mm, unsigned threads, std::vector<Estimate>& estimates);

}  // namespace softgrip::sysid
