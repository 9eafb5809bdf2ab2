#pragma once
// Computes a gain that is positive for every argument. Blocks for effects that grow without a limit, such as
// ageing, use this gain.

#include "model/number.h"

namespace softgrip::model {

/// Returns 1 + x for x >= -1/2, and -1/(4 x) for smaller x. The result is positive and monotone in x, and its
/// value and slope are continuous. The gain is linear in x as long as it is at least 1/2.
template <class T>
[[nodiscard]] T positive_gain(const T& x) {
  return value_of(x) >= -0.5 ? T(1.0 + x) : T(-0.25 / x);
}

}  // namespace softgrip::model
