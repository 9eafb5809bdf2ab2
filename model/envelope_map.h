#pragma once
// Maps the pressure to the envelope of generalised play operators.

#include "model/dual.h"

namespace softgrip::model {

/// Computes a function b(p) of the pressure p. For p from 0 to P, b is a cubic through (0, 0) and (P, P):
///
///     b(p) = p (1 - (1 - x)(bend - skew (1 - 2 x))),   x = p/P
///
/// Below 0 and above P, b is linear, with the slope that the cubic has at 0 or at P. b rises everywhere if
/// |bend| + |skew| < 1. A generalised play operator (Krasnosel'skii and Pokrovskii, Systems with Hysteresis,
/// 1989, section 1.2) has two envelopes. If both envelopes are shifted copies of b, the operator equals a
/// play operator with the input b(p).
template <class T>
class EnvelopeMap {
 public:
  /// Largest absolute values of bend and skew. b rises for every combination within these limits.
  static constexpr double most_bend = 0.6, most_skew = 0.35;

  /// @param bend  half of the difference between the slopes b'(P) and b'(0).
  /// @param skew  decreases the slope in the middle of the range: b'(P/2) = 1 - skew/2.
  /// @param end_kpa  upper end P of the range [kPa], > 0; without effect if bend and skew are 0.
  EnvelopeMap(const T& bend, const T& skew, const T& end_kpa)
      : bend_(bend), skew_(skew), end_kpa_(end_kpa), bends_(!(is_zero(bend) && is_zero(skew))) {}

  /// Returns true if the map b(p) differs from p.
  [[nodiscard]] bool bends() const { return bends_; }

  template <class U>
  [[nodiscard]] U value(const U& p) const {
    if (!bends_) return p;
    if (value_of(p) <= 0.0) return U(p * (1.0 - bend_ + skew_));
    if (value_of(p) >= value_of(end_kpa_)) return U(end_kpa_ + (p - end_kpa_) * (1.0 + bend_ + skew_));
    const U left = 1.0 - p / end_kpa_;
    return U(p * (1.0 - left * (bend_ + skew_ - 2.0 * skew_ * left)));
  }

 private:
  T bend_, skew_, end_kpa_;
  bool bends_;
};

}  // namespace softgrip::model
