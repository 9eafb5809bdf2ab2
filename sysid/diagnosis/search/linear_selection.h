#pragma once
// Selects causes if the base structure has many parameters (play operators, a Kelvin-Voigt chain). The search
// varies only the few parameters of the cause. The parameters of the base structure are assumed to respond
// linearly to the cause.
// Fits the parameters of one cause. The base structure is not refitted; its parameters are assumed to respond
// linearly to the cause.

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/scan.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Effort of the final fit of base structure and causes. This fit starts at the result of the selection.
inline constexpr FitEffort finishing_effort{.most_iterations = 15, .tolerance = 1e-6};

/// Selects causes in addition to a base structure.
/// @param base  base structure that was fitted to data.records.
/// @param options  the members one_cause_stands and to_beat_mm2 are not used.
[[nodiscard]] Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                                           const Division& division, const SelectionOptions& options);

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
