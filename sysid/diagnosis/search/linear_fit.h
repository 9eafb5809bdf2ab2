#pragma once
// Fits the parameters of one cause. The base structure is not refitted; its parameters are assumed to respond
// linearly to the cause.

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/scan.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Result of a fit of one cause to thinned records. The parameters of the base structure respond linearly to
/// the cause.
struct LinearFit {
  /// Model with the fitted parameters of the cause; the parameters of the base structure are not changed.
  FitPoint beside;
  Eigen::VectorXd left;
  /// Mean square of the residual after the base structure has responded to the cause.
  double mean_square_mm2 = std::numeric_limits<double>::infinity();
};

/// Fits a cause to thinned records. Returns an infinite mean square if the result of the fit cannot be
/// simulated.
/// @param base  base structure on the same records.
/// @param start  model with the cause, at which the fit starts.
[[nodiscard]] LinearFit linear_fit_from(const std::vector<Record>& records, const Scan& base,
                                        const Cause& cause, const FitPoint& start);

}  // namespace softgrip::sysid
