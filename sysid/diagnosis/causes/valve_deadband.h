#pragma once
// Defines a cause: the valve has a dead band. It does not respond to changes of the command within this band.
// When the command leaves the band, the valve follows with play, or it sticks and jumps.

#include <cmath>

#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_stiction.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct ValveDeadband {
  static constexpr std::string_view id = "valve_deadband";
  static constexpr WhenChanged when_changed{
      "the valve ignores small changes of the command",
      {"Command steps of 1 kPa up and down and note which steps the pressure follows.",
       "Clean the valve or cycle it 50 times over its range, and record the same log again."},
      {},
      {SizedBy::Of::number, "dead band of the valve", "kPa", "band_kpa"}};

  /// Form of the cause: the valve follows the command with play.
  struct Play : FormOf<model::ValveDeadband> {
    static Starts starts(const Scales& s) {
      return every({{"band_kpa", {0.01 * s.largest_kpa, 0.05 * s.largest_kpa, 0.15 * s.largest_kpa}}});
    }
  };

  /// Form of the cause: the valve sticks and then jumps to the command.
  struct Stiction : FormOf<model::ValveStiction> {
    static Starts starts(const Scales& s) {
      Starts starts;
      for (const double band : bands_kpa(s)) starts.push_back(start({{"band_kpa", band}}));
      return starts;
    }

    /// Returns start values of the band. A sticking valve reaches the largest pressure in jumps whose size
    /// equals the band. The model error has a local minimum at each band for which the number of jumps is an
    /// integer, and the largest pressure of a log need not be such a multiple of the true band. There are two
    /// start values per number of jumps, down to a band of 1/60 of the largest pressure. Smaller bands have
    /// similar effects, so the next start values are 10 % apart.
    static std::vector<double> bands_kpa(const Scales& s) {
      std::vector<double> bands;
      for (int halves = 10; halves < 120; ++halves) bands.push_back(2 * s.largest_kpa / halves);
      for (int i = 0; i < 19; ++i) bands.push_back(s.largest_kpa / (60 * std::pow(1.1, i)));
      return bands;
    }
  };

  using Forms = List<Play, Stiction>;
};

}  // namespace softgrip::sysid::causes
