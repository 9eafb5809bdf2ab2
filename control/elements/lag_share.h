#pragma once
// Computes the response of a first-order lag in one step.

#include <cmath>

namespace softgrip::control {

/// Returns the share of the distance to a constant input that a first-order lag covers in `step_s` >= 0. It
/// is 1 - exp(-step / tau), or 1 without a time constant.
[[nodiscard]] inline double lag_share(double step_s, double time_constant_s) noexcept {
  return time_constant_s > 0 ? -std::expm1(-step_s / time_constant_s) : 1;
}

}  // namespace softgrip::control
