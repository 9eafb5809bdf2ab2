#pragma once
// How large an effect must be so that a recalibrated model without it misses by a wanted amount.

#include <string>
#include <vector>

#include "world.h"

namespace blind {

/// RMS [mm] over the campaign of what the effect adds to the displacement and no small change of the base
/// parameters and of the zero can take away (linear projection on finite differences).
double excess_mm(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                 std::uint64_t seed);

struct Scaled {
  Effect effect;
  double excess_mm = 0;   ///< reached
  bool reachable = true;  ///< false: even the largest physical effect stays below
};

/// The effect `id` scaled to `target_mm` of excess.
Scaled scale_to(const std::string& id, double target_mm, const Base& base, const std::vector<LogInput>& logs,
                std::uint64_t seed);

}  // namespace blind
