#pragma once
// How far and how fast the free finger of a model goes within its limits: what the limits are compared with.

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

struct FreeMotion {
  double rest_mm = 0;     ///< at rest under the rest pressure
  double lowest_mm = 0;   ///< three seconds after the lowest pressure was reached; rest_mm if that is it
  double highest_mm = 0;  ///< three seconds after the highest pressure was reached
  double fastest_mm_per_s = 0;  ///< on the way up and down, as fast as the slew limits allow
};

/// Steps the model through the whole pressure range and back, in a few thousand steps. Noise and dead times
/// are omitted.
[[nodiscard]] FreeMotion free_motion(const model::Model& model, const LimitSettings& limits);

}  // namespace softgrip::control
