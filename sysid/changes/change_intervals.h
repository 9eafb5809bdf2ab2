#pragma once
// Computes the uncertainty of the sizes of changes.

#include <optional>
#include <vector>

#include "sysid/changes/change_search.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// 95 % intervals of one effect; empty for a parameter that has no effect on the readings.
struct EffectIntervals {
  std::vector<std::optional<Interval>> numbers;  ///< intervals of the parameters, limited to their bounds
  std::optional<Interval> size;                  ///< interval of the size; see size_of()
};

/// A healthy unit that was left out of the fit, and the effects that the search finds in it although the
/// finger has not changed.
struct HealthyFits {
  LaterReadings readings;
  std::vector<ScoredEffect> ranked;
};

/// Computes the intervals of all effects together for a constant baseline model. Uses the sandwich estimator
/// over blocks of some seconds (Liang and Zeger, Biometrika 73, 1986) and adds the variance of the same
/// parameter between healthy units. The interval of a size follows from its derivatives with respect to the
/// parameters.
/// @param found  effects in the readings.
/// @param healthy  fits in the healthy units, one element per unit.
/// @return intervals, one element per effect.
[[nodiscard]] std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                                        const std::vector<FittedEffect>& found,
                                                        const std::vector<HealthyFits>& healthy);

}  // namespace softgrip::sysid
