#pragma once
// Scales an effect so that a refitted model without it has a requested error.

#include <string>
#include <vector>

#include "world.h"

namespace blind {

/// Returns the part of an effect's change of the displacement [mm RMS over the campaign] that no small change
/// of the base parameters and of the zero can explain (linear projection on finite differences).
double excess_mm(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                 std::uint64_t seed);

struct Scaled {
  Effect effect;
  double excess_mm = 0;   ///< reached
  bool reachable = true;  ///< false: even the largest physical effect is below the target
};

/// Returns the effect `id`, scaled to an excess of `target_mm`.
Scaled scale_to(const std::string& id, double target_mm, const Base& base, const std::vector<LogInput>& logs,
                std::uint64_t seed);

}  // namespace blind
