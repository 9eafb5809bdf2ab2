#pragma once
// Computes the displacement and the speed that a model's free finger reaches within its limits. The results
// are compared with the limits of the rig file.

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

struct FreeMotion {
  double rest_mm = 0;           ///< displacement of the finger at rest under the rest pressure
  double lowest_mm = 0;         ///< three seconds after the command went to the lowest pressure
  double highest_mm = 0;        ///< three seconds after the command went to the highest pressure
  double fastest_mm_per_s = 0;  ///< largest speed in both directions within the slew limits
};

/// Simulates the model through the complete pressure range and back, in a few thousand steps. Noise and dead
/// times are left out.
[[nodiscard]] FreeMotion free_motion(const model::Model& model, const LimitSettings& limits);

}  // namespace softgrip::control
