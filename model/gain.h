#pragma once
// A gain that stays positive whatever its argument, for effects that drift without bound.

#include "model/number.h"

namespace softgrip::model {

/// 1 + x for x >= 0, 1/(1 - x) below: positive, monotone, smooth in value and slope at 0, never overflowing
/// for finite x.
template <class T>
[[nodiscard]] T positive_gain(const T& x) {
  return value_of(x) >= 0.0 ? T(1.0 + x) : T(1.0 / (1.0 - x));
}

}  // namespace softgrip::model
