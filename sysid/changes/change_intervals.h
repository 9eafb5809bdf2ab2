#pragma once
// Uncertainty of the sizes of changes.

#include <optional>
#include <vector>

#include "sysid/changes/change_search.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// 95 % intervals of one effect; nullopt if a parameter has no effect on the readings.
struct EffectIntervals {
  std::vector<std::optional<Interval>> numbers;  ///< within the bounds of the parameters
  std::optional<Interval> size;                  ///< interval of the value of size_of()
};

/// A healthy unit that was left out, and the effects that the search finds in it without a change.
struct HealthyFits {
  LaterReadings readings;
  std::vector<ScoredEffect> ranked;
};

/// Computes the intervals of all effects together, with a constant base, by the sandwich estimator over
/// blocks of some seconds (Liang and Zeger, Biometrika 73, 1986). The variance of the same parameter between
/// healthy units is added. The interval of a size follows from the derivatives with respect to the
/// parameters.
/// @param found  effects in the readings. @param healthy  one for each unit. @return one for each effect.
[[nodiscard]] std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                                        const std::vector<FittedEffect>& found,
                                                        const std::vector<HealthyFits>& healthy);

}  // namespace softgrip::sysid
