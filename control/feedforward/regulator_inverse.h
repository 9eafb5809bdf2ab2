#pragma once
// The command that makes a pressure regulator bring its pressure somewhere one tick from now.

#include "model/regulated_pressure.h"

namespace softgrip::control {

/// Which way a pressure is to move that has `way_kpa` to go in a tick, -1 to 1. Whole where it moves at all;
/// a part of it where it hardly does: what then went by half a dead band would do nothing but noise.
[[nodiscard]] double direction_of(double way_kpa, double tick_s) noexcept;

/// Of a regulator whose command is held for a tick (model/regulated_pressure.h). In closed form from where
/// spool and integral stand, with the integral straight over the tick and as much passed by a port as in the
/// tick before: a thousandth of the way is left to the next tick, which begins where the pressure then is.
class RegulatorInverse {
 public:
  /// @param tick_s  > 0.
  RegulatorInverse(const model::RegulatedPressure<double>& regulated, double tick_s);

  /// The regulator stands as this one does; of the same numbers.
  void take_over(const model::RegulatedPressure<double>& regulated) noexcept;

  /// The command under which the pressure is at `next_kpa` at the end of the tick; where no port opens far
  /// enough, one under which it is open as far as it gets. Changes nothing.
  [[nodiscard]] double command_for(double next_kpa) const noexcept;
  /// Moves on by one tick; the pressure at its end [kPa].
  double advance(double command_kpa) noexcept;

 private:
  model::RegulatedPressure<double> regulated_;
  double tick_s_;
  double filling_share_, venting_share_;  ///< of the error beyond the overlap that goes in a tick
};

}  // namespace softgrip::control
