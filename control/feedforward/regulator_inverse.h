#pragma once
// The command that makes a pressure regulator bring its pressure somewhere one tick from now.

#include "model/regulated_pressure.h"

namespace softgrip::control {

/// Returns the direction of a pressure change of `way_kpa` in a tick, -1 to 1. The value is full for a real
/// motion and partial for a very small one. A small change with half a dead band would only add noise.
[[nodiscard]] double direction_of(double way_kpa, double tick_s) noexcept;

/// Inverse of a regulator whose command is held for a tick (model/regulated_pressure.h). It is a closed form
/// from the present spool and integral. It assumes a linear integral over the tick and the same port flow as
/// in the last tick. An error of 0.1 % of the change remains for the next tick, which starts from the actual
/// pressure.
class RegulatorInverse {
 public:
  /// @param tick_s  > 0.
  RegulatorInverse(const model::RegulatedPressure<double>& regulated, double tick_s);

  /// Copies the state of `regulated`, which must have the same parameters.
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
