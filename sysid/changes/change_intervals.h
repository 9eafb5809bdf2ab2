#pragma once
// Computes confidence intervals for the sizes of changes.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sysid/changes/change_search.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// Parameters of one effect with their 95 % confidence intervals. An interval is missing if the parameter has
/// no effect on the readings.
struct EffectIntervals {
  std::vector<double> values;  ///< values of the parameters; a position is stated in the later readings,
                               ///< including their zero offset
  std::vector<std::optional<Interval>> numbers;  ///< intervals of the parameters, limited to the permitted
                                                 ///< range of each parameter
  std::optional<Interval> size;                  ///< interval of the result of size_of()
};

/// A healthy cross-validation unit that was left out of the fit, and the effects that the search finds in
/// this unit. The finger has not changed in this unit, so the effects are errors of the search.
struct HealthyFits {
  LaterReadings readings;
  std::vector<ScoredEffect> ranked;
};

/// Computes the intervals of all effects together. The variance of a parameter is the sum of three variances.
/// The first one is the variance of the sandwich estimator over blocks of some seconds (Liang and Zeger,
/// Biometrika 73, 1986). The second one is the variance of the same parameter between healthy units. The
/// third one is the variance because of the uncertainty of the baseline model (jackknife). The interval of a
/// size is computed from the derivatives of the size with respect to the parameters.
/// @param found  effects in the readings.
/// @param healthy  fits in the healthy units, one element per unit.
/// @param left_out  later readings relative to the baseline models that were fitted without one unit
/// (left_out_readings()).
/// @return intervals, one element per effect.
[[nodiscard]] std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                                        const std::vector<FittedEffect>& found,
                                                        const std::vector<HealthyFits>& healthy,
                                                        std::span<const LaterReadings> left_out = {});

/// Returns the sources of uncertainty that these intervals contain, in words.
/// @param later_runs  number of later runs.
[[nodiscard]] std::vector<std::string> contained_in_intervals(const Base& base, std::size_t later_runs);

}  // namespace softgrip::sysid
