#pragma once
// Computes the response of a first-order lag in one step.

#include <cmath>

namespace softgrip::control {

/// Returns the share of the distance from the output of a first-order lag to its constant input that the
/// output covers in the time `step_s` >= 0. The share is 1 - exp(-step_s / time_constant_s), or 1 if the time
/// constant is 0.
[[nodiscard]] inline double lag_share(double step_s, double time_constant_s) noexcept {
  return time_constant_s > 0 ? -std::expm1(-step_s / time_constant_s) : 1;
}

}  // namespace softgrip::control
