#pragma once
// Computes confidence intervals for the sizes of changes.

#include <optional>
#include <vector>

#include "sysid/changes/change_search.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// 95 % confidence intervals of one effect. An interval is missing if the parameter has no effect on the
/// readings.
struct EffectIntervals {
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

/// Computes the intervals of all effects together. The parameters of the baseline model are constant. The
/// variance of a parameter is the sum of two variances. The first one is the variance of the sandwich
/// estimator over blocks of some seconds (Liang and Zeger, Biometrika 73, 1986). The second one is the
/// variance of the same parameter between healthy units. The interval of a size is computed from the
/// derivatives of the size with respect to the parameters.
/// @param found  effects in the readings.
/// @param healthy  fits in the healthy units, one element per unit.
/// @return intervals, one element per effect.
[[nodiscard]] std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                                        const std::vector<FittedEffect>& found,
                                                        const std::vector<HealthyFits>& healthy);

}  // namespace softgrip::sysid
