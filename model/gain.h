#pragma once
// Computes a gain that is positive for every argument. Effects that drift without a limit use this gain.

#include "model/number.h"

namespace softgrip::model {

/// Returns 1 + x for x >= -1/2, and -1/(4 x) for smaller x. The result is positive and monotone, and its
/// value and slope are continuous. The gain follows the linear law as long as the actuator keeps at least
/// half its gain.
template <class T>
[[nodiscard]] T positive_gain(const T& x) {
  return value_of(x) >= -0.5 ? T(1.0 + x) : T(-0.25 / x);
}

}  // namespace softgrip::model
