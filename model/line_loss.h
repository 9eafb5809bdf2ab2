#pragma once
// Computes the pressure drop between a regulator and a finger with a leak.

#include "model/number.h"

namespace softgrip::model {

/// A steady flow through the line into the open, both openings by ISO 6358-1 with a critical ratio of a half:
/// through the line C sqrt(p dp), nearly, and through the leak that share of it at which the line loses
/// `share` of a small pressure (the squared ratio of the conductances). Choked above one atmosphere.
/// Pressures are gauge [kPa]. Increasing; below 0 a straight line goes on.
template <class T>
struct LineLoss {
  T share;  ///< >= 0

  static constexpr double atmosphere_kpa = 101.325;

  /// Before the line, of the pressure at the finger: p + share p a / (p + a) up to one atmosphere a.
  template <class U>
  [[nodiscard]] U before(const U& p) const {
    if (value_of(p) <= 0.0) return p * (1.0 + share);
    if (value_of(p) > atmosphere_kpa) return p + share * 0.25 * (p + atmosphere_kpa);
    return p + share * atmosphere_kpa * p / (p + atmosphere_kpa);
  }

  /// At the finger, of the pressure before the line: the positive root of the above.
  template <class U>
  [[nodiscard]] U behind(const U& u) const {
    using std::sqrt;
    if (value_of(u) <= 0.0) return u / (1.0 + share);
    const T quarter = share * 0.25;
    if (value_of(u) > atmosphere_kpa * (1.0 + 0.5 * value_of(share)))
      return (u - quarter * atmosphere_kpa) / (1.0 + quarter);
    const U half = (u - atmosphere_kpa * (1.0 + share)) * 0.5;
    return half + sqrt(half * half + u * atmosphere_kpa);
  }
};

}  // namespace softgrip::model
