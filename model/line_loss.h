#pragma once
// Computes the pressure drop between a regulator and a finger that has a leak.

#include "model/dual.h"
#include "model/port_flow.h"

namespace softgrip::model {

/// Computes the pressures before and behind a line whose flow leaves through a leak. The steady flow passes
/// through the line, and then through the leak to the atmosphere. Line and leak are restrictions according to
/// ISO 6358-1 with a critical pressure ratio of 0.5. The flow through the line is approximately C sqrt(p dp),
/// with the conductance C and the pressure drop dp. At small pressures, the pressure drop of the line is
/// `share` times the pressure at the finger. `share` is the squared ratio of the two conductances. The flow
/// through the leak is choked above a gauge pressure of one atmosphere. All pressures are gauge pressures
/// [kPa]. before() and behind() increase with their argument and are linear for negative arguments.
template <class T>
struct LineLoss {
  T share;  ///< ratio of the pressure drop of the line to the pressure at the finger, at small pressures; >=
            ///< 0

  /// Returns the pressure before the line for the pressure `p` at the finger. For p from 0 to the atmospheric
  /// pressure a, the result is p + share p a / (p + a).
  template <class U>
  [[nodiscard]] U before(const U& p) const {
    if (value_of(p) <= 0.0) return p * (1.0 + share);
    if (value_of(p) > atmosphere_kpa) return p + share * 0.25 * (p + atmosphere_kpa);
    return p + share * atmosphere_kpa * p / (p + atmosphere_kpa);
  }

  /// Returns the pressure at the finger for the pressure `u` before the line. The result is the positive root
  /// of the equation before(p) = u.
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
