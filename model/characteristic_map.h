#pragma once
// Computes a nonlinear, monotone map through the points (0, 0) and (span, span).

#include <cmath>

#include "model/dual.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Computes the map g(z) = span expm1(a z/span) / expm1(a) for z in [0, span], where a is the curvature.
/// Outside this range, the map continues as straight lines. The map is smooth in a at a = 0, where g(z) = z.
template <class T>
class CharacteristicMap {
 public:
  /// @param curvature  the curvature a.  @param span_mm  the span, > 0.
  CharacteristicMap(const T& curvature, const T& span_mm)
      : curvature_(curvature),
        span_mm_(span_mm),
        per_mm_(curvature / span_mm),
        phi1_(phi1(curvature)),
        first_slope_(1.0 / phi1_),
        last_slope_(exponential(curvature) / phi1_) {}

  [[nodiscard]] const T& curvature() const { return curvature_; }

  template <class U>
  [[nodiscard]] U value(const U& z) const {
    if (value_of(z) <= 0.0) return U(first_slope_ * z);
    if (value_of(z) >= value_of(span_mm_)) return U(span_mm_ + last_slope_ * (z - span_mm_));
    return U(z * (phi1(U(per_mm_ * z)) / phi1_));
  }
  [[nodiscard]] T slope(const T& z) const {
    if (value_of(z) <= 0.0) return first_slope_;
    if (value_of(z) >= value_of(span_mm_)) return last_slope_;
    return exponential(curvature_ * z / span_mm_) / phi1_;
  }
  [[nodiscard]] T inverse(const T& y) const {
    using std::log1p;
    if (value_of(y) <= 0.0) return y * phi1_;
    if (value_of(y) >= value_of(span_mm_)) return span_mm_ + (y - span_mm_) / last_slope_;
    const T share = y / span_mm_;
    // If the curvature a is almost 0 (|a| < 1e-9), the quotient in the last statement approaches 0/0. The map
    // is then linear apart from rounding.
    if (std::abs(value_of(curvature_)) < 1e-9) return y;
    return span_mm_ * (log1p(share * (curvature_ * phi1_)) / curvature_);
  }

 private:
  [[nodiscard]] static T exponential(const T& x) {
    using std::exp;
    return exp(x);
  }

  T curvature_;
  T span_mm_;
  T per_mm_;  ///< curvature of the map divided by its span
  T phi1_;    ///< phi_1(a) = (exp(a) - 1) / a for the curvature a
  T first_slope_, last_slope_;
};

}  // namespace softgrip::model
