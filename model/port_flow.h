#pragma once
// Computes the flow of air through a port.

#include <cmath>

#include "model/dual.h"

namespace softgrip::model {

/// Atmospheric pressure [kPa].
inline constexpr double atmosphere_kpa = 101.325;

/// Returns the flow through a port, divided by its sonic conductance [kPa]. The flow follows ISO 6358-1 with
/// the critical pressure ratio of a common port, 0.3. Above a pressure ratio of 0.995, the flow is linear in
/// the ratio, as the standard permits. The derivative is then finite at equal pressures.
/// @param from_kpa, to_kpa  absolute pressures; from_kpa >= to_kpa > 0.
template <class T>
[[nodiscard]] T port_flow(const T& from_kpa, const T& to_kpa) {
  using std::sqrt;
  static constexpr double critical_ratio = 0.3, linear_above = 0.995;
  const auto subsonic = []<class Ratio>(const Ratio& ratio) -> Ratio {
    const Ratio x = (ratio - critical_ratio) * (1 / (1 - critical_ratio));
    return sqrt(1.0 - x * x);
  };
  const T ratio = to_kpa / from_kpa;
  if (value_of(ratio) <= critical_ratio) return from_kpa;
  if (value_of(ratio) < linear_above) return from_kpa * subsonic(ratio);
  return from_kpa * (subsonic(linear_above) * ((1.0 - ratio) * (1 / (1 - linear_above))));
}

}  // namespace softgrip::model
