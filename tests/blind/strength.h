#pragma once
// Scales an effect so that a refitted model without this effect has a requested error.

#include <string>
#include <vector>

#include "world.h"

namespace blind {

/// Returns the excess of an effect: the part of the displacement change by the effect [mm RMS over the
/// campaign] that small changes of the base parameters and of the zero cannot explain. The part is found by
/// linear projection on finite differences.
double excess_mm(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                 std::uint64_t seed);

struct Scaled {
  Effect effect;
  double excess_mm = 0;   ///< excess error that the scaled effect causes
  bool reachable = true;  ///< false: even the largest physical size of the effect causes less than the target
};

/// Returns the effect `id`, scaled to an excess of `target_mm`.
Scaled scale_to(const std::string& id, double target_mm, const Base& base, const std::vector<LogInput>& logs,
                std::uint64_t seed);

}  // namespace blind
