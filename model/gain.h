#pragma once
// Computes a gain that is positive for every argument, for effects that drift without bound.

#include "model/number.h"

namespace softgrip::model {

/// Returns 1 + x for x >= -1/2 and -1/(4 x) below. The result is positive and monotone, and value and slope
/// are continuous. The linear law holds while the actuator keeps at least half its gain.
template <class T>
[[nodiscard]] T positive_gain(const T& x) {
  return value_of(x) >= -0.5 ? T(1.0 + x) : T(-0.25 / x);
}

}  // namespace softgrip::model
