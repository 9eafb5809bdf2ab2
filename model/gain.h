#pragma once
// Computes a gain that is positive for every argument, for effects that drift without bound.

#include "model/number.h"

namespace softgrip::model {

/// 1 + x for x >= -1/2, -1/(4 x) below: positive, monotone, smooth in value and slope, and the plain linear
/// law wherever an actuator keeps at least half its gain.
template <class T>
[[nodiscard]] T positive_gain(const T& x) {
  return value_of(x) >= -0.5 ? T(1.0 + x) : T(-0.25 / x);
}

}  // namespace softgrip::model
