#pragma once
// How sure the sizes of changes are.

#include <optional>
#include <vector>

#include "sysid/changes/change_search.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// 95 % intervals of one effect; none where the readings do not feel a number.
struct EffectIntervals {
  std::vector<std::optional<Interval>> numbers;  ///< within the numbers' bounds
  std::optional<Interval> size;                  ///< of what size_of() says
};

/// A healthy unit that was left out, and what the search finds in it, where nothing has changed.
struct HealthyFits {
  LaterReadings readings;
  std::vector<ScoredEffect> ranked;
};

/// All effects together, the base frozen, by the sandwich estimator over blocks of some seconds (Liang and
/// Zeger, Biometrika 73, 1986). To its variance comes that of the same number between healthy units. A size
/// follows by the slopes of its numbers.
/// @param found  what explains the readings. @param healthy  one for each unit. @return one for each effect.
[[nodiscard]] std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                                        const std::vector<FittedEffect>& found,
                                                        const std::vector<HealthyFits>& healthy);

}  // namespace softgrip::sysid
