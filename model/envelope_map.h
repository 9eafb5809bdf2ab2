#pragma once
// Maps the pressure to the envelope of generalised play operators.

#include "model/number.h"

namespace softgrip::model {

/// b(p) = p (1 - (1 - x)(bend - skew (1 - 2 x))) with x = p/P on [0, P]. This is the cubic through (0, 0) and
/// (P, P); outside the range, it continues as straight lines. A generalised play (Krasnosel'skii and
/// Pokrovskii, Systems with Hysteresis, 1989, section 1.2) whose two envelopes are shifted copies of this
/// curve equals a play of b(p). b rises everywhere if |bend| + |skew| < 1.
template <class T>
class EnvelopeMap {
 public:
  /// Largest absolute values of bend and skew. b rises for every combination within these limits.
  static constexpr double most_bend = 0.6, most_skew = 0.35;

  /// @param bend  half of the difference between the slopes b'(P) and b'(0).  @param skew  if it is above 0,
  /// b
  /// is less steep in the middle.  @param end_kpa  P, > 0. It has no effect if bend and skew are 0.
  EnvelopeMap(const T& bend, const T& skew, const T& end_kpa)
      : bend_(bend), skew_(skew), end_kpa_(end_kpa), bends_(!(is_zero(bend) && is_zero(skew))) {}

  /// Returns false if the map is b(p) = p.
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
