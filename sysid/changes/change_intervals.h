#pragma once
// How sure the sizes of changes are.

#include <optional>
#include <vector>

#include "sysid/changes/effect_fit.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// 95 % intervals of one effect; none where the readings do not feel a number.
struct EffectIntervals {
  std::vector<std::optional<Interval>> numbers;  ///< within the numbers' bounds
  std::optional<Interval> size;                  ///< of what size_of() says
};

/// All effects together, the base frozen, by the sandwich estimator over blocks of some seconds, within which
/// what is left may be as it likes (Liang and Zeger, Biometrika 73, 1986), and widened by what a base adds
/// that is not certain itself; a size by the numbers' slopes.
/// @param found  what explains the readings. @return one for each.
[[nodiscard]] std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                                        const std::vector<FittedEffect>& found);

}  // namespace softgrip::sysid
