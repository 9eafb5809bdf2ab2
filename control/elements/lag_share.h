#pragma once
// Computes the response of a first-order lag in one step.

#include <cmath>

namespace softgrip::control {

/// The share of the way to a held input that a first-order lag goes in `step_s` >= 0, 1 - exp(-step / tau);
/// all of it without a time constant.
[[nodiscard]] inline double lag_share(double step_s, double time_constant_s) noexcept {
  return time_constant_s > 0 ? -std::expm1(-step_s / time_constant_s) : 1;
}

}  // namespace softgrip::control
