#pragma once
// A bent, monotone map through (0, 0) and (span, span).

#include <cmath>

#include "model/exponential.h"
#include "model/number.h"

namespace softgrip::model {

/// g(z) = span expm1(a z/span) / expm1(a) on [0, span], straight beyond; smooth in a through 0, where g(z) =
/// z.
template <class T>
struct CharacteristicMap {
  T curvature;  ///< a
  T span_mm;

  /// g'(0) and g'(span).
  [[nodiscard]] T first_slope() const { return 1.0 / phi1(curvature); }
  [[nodiscard]] T last_slope() const {
    using std::exp;
    return exp(curvature) / phi1(curvature);
  }

  template <class U>
  [[nodiscard]] U value(const U& z) const {
    if (value_of(z) <= 0.0) return U(first_slope() * z);
    if (value_of(z) >= value_of(span_mm)) return U(span_mm + last_slope() * (z - span_mm));
    return U(z * (phi1(U(curvature / span_mm * z)) / phi1(curvature)));
  }
  [[nodiscard]] T slope(const T& z) const {
    using std::exp;
    if (value_of(z) <= 0.0) return first_slope();
    if (value_of(z) >= value_of(span_mm)) return last_slope();
    return exp(curvature * z / span_mm) / phi1(curvature);
  }
  [[nodiscard]] T inverse(const T& y) const {
    using std::log1p;
    if (value_of(y) <= 0.0) return y * phi1(curvature);
    if (value_of(y) >= value_of(span_mm)) return span_mm + (y - span_mm) / last_slope();
    const T share = y / span_mm;
    // Below this |a| the logarithm's quotient is 0/0 and the map straight to rounding.
    if (std::abs(value_of(curvature)) < 1e-9) return y;
    return span_mm * (log1p(share * (curvature * phi1(curvature))) / curvature);
  }
};

}  // namespace softgrip::model
