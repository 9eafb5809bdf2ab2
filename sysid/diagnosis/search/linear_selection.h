#pragma once
// Selects causes for a base structure with many parameters, such as play operators or a Kelvin-Voigt chain.
// The search changes only the few parameters of the cause. It assumes that the parameters of the base
// structure respond linearly to the cause.
// Fits the parameters of one cause. The base structure is not refitted. Instead, the fit assumes that the
// parameters of the base structure respond linearly to the cause.

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/scan.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Effort of the final fit of base structure and causes, which starts at the result of the selection.
inline constexpr FitEffort finishing_effort{.most_iterations = 15, .tolerance = 1e-6};

/// Selects causes that are added to a base structure.
/// @param base  base structure, fitted to data.records.
/// @param options  options; the function ignores the members one_cause_stands and to_beat_mm2.
[[nodiscard]] Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                                           const Division& division, const SelectionOptions& options);

/// Result of a fit of one cause to thinned records.
struct LinearFit {
  /// Model with the fitted parameters of the cause. The parameters of the base structure keep their values.
  FitPoint beside;
  Eigen::VectorXd left;
  /// Mean square of the residual after the linear response of the base structure to the cause.
  double mean_square_mm2 = std::numeric_limits<double>::infinity();
};

/// Fits a cause to thinned records. If the model cannot be simulated with the fitted parameters, the mean
/// square of the result is infinite.
/// @param base  scan of the base structure on the same records.
/// @param start  model with the cause, at which the fit starts.
[[nodiscard]] LinearFit linear_fit_from(const std::vector<Record>& records, const Scan& base,
                                        const Cause& cause, const FitPoint& start);

}  // namespace softgrip::sysid
