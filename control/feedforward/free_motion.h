#pragma once
// Computes the displacements and the speed that a finger without contact reaches within the limits of its
// channel. The results are compared with the limits in the rig file.

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

struct FreeMotion {
  double rest_mm = 0;           ///< displacement of the finger at rest under the rest pressure
  double lowest_mm = 0;         ///< displacement 3 s after the command went to the lowest pressure
  double highest_mm = 0;        ///< displacement 3 s after the command went to the highest pressure
  double fastest_mm_per_s = 0;  ///< largest speed, upward or downward, within the slew limits
};

/// Simulates the model through the complete pressure range and back, in a few thousand steps. The simulation
/// leaves out noise and dead times.
[[nodiscard]] FreeMotion free_motion(const model::Model& model, const LimitSettings& limits);

}  // namespace softgrip::control
