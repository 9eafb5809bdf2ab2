#pragma once
// Scales a hidden effect. After the scaling, a model that is refitted without this effect has a requested RMS
// error.

#include <string>
#include <vector>

#include "world.h"

namespace blind {

using worlds::Scaled;

/// Computes the change of the displacement that an effect causes. Removes the part of this change that small
/// changes of the actuator parameters and of the zero can explain, by a linear projection on finite
/// differences. Returns the RMS [mm] of the remaining change over the campaign.
double excess_mm(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                 std::uint64_t seed);

/// Returns the effect `id`, scaled so that a model that is refitted without the effect has the RMS error
/// `target_mm`, within about 3 %. If this error is not reachable, returns the effect with its largest
/// physical size.
Scaled scale_to(const std::string& id, double target_mm, const Base& base, const std::vector<LogInput>& logs,
                std::uint64_t seed);

}  // namespace blind
