#pragma once
// The valve ignores changes smaller than a band: it drags along behind the command, or sticks and jumps.

#include <cmath>

#include "model/blocks/valve_deadband.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct ValveDeadband : FormOf<model::ValveDeadband> {
  static Starts starts(const Scales& s) {
    Starts starts = every({{"band_kpa", {0.01 * s.largest_kpa, 0.05 * s.largest_kpa, 0.15 * s.largest_kpa}}});
    for (const double band : jumping_bands_kpa(s))
      starts.push_back(start({{"band_kpa", band}, {"form", 1.0}}));
    return starts;
  }

  /// Bands of a valve that sticks and jumps. The misfit has a minimum wherever the staircase gains or loses a
  /// step on the way to the largest pressure: starts a step apart leave none out, down to bands of 1/60 of
  /// it. Smaller ones differ by little more than their size.
  static std::vector<double> jumping_bands_kpa(const Scales& s) {
    std::vector<double> bands;
    for (int steps = 5; steps < 60; ++steps) bands.push_back(s.largest_kpa / steps);
    for (int i = 0; i < 19; ++i) bands.push_back(s.largest_kpa / (60 * std::pow(1.1, i)));
    return bands;
  }

  /// For where the band is found otherwise than by a fit (staircase.h).
  static Values with_band(double band_kpa, bool jumps) {
    return start({{"band_kpa", band_kpa}, {"form", jumps ? 1.0 : 0.0}});
  }
};

}  // namespace softgrip::sysid::causes
