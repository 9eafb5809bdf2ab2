#pragma once
// Finds the command with which a pressure regulator reaches a given pressure after one tick.

#include "model/regulated_pressure.h"

namespace softgrip::control {

/// Returns the direction of a pressure change of `way_kpa` in a tick, -1 to 1. The magnitude is 1 for a
/// change that is faster than 0.2 kPa/s. For a slower change, the magnitude is smaller, because adding half
/// of a dead band to a slow change would add noise.
[[nodiscard]] double direction_of(double way_kpa, double tick_s) noexcept;

/// Inverse of a pressure regulator whose command is held for a tick (model/regulated_pressure.h). A formula
/// gives the command from the present state of the spool and of the integral. The formula assumes that the
/// integral changes linearly during the tick, and that the flow coefficient of the port has not changed since
/// the last tick. The error of the resulting pressure is 0.1 % of the pressure change. The next tick starts
/// from the actual pressure and corrects this error.
class RegulatorInverse {
 public:
  /// @param tick_s  duration of a tick [s], > 0.
  RegulatorInverse(const model::RegulatedPressure<double>& regulated, double tick_s);

  /// Copies the state of `regulated`, which must have the same parameters.
  void take_over(const model::RegulatedPressure<double>& regulated) noexcept;

  /// Returns the command for which the pressure is `next_kpa` at the end of the tick. If no port can open far
  /// enough for this pressure, returns a command that opens the port fully. Does not change the state.
  [[nodiscard]] double command_for(double next_kpa) const noexcept;
  /// Advances by one tick and returns the pressure at the end of the tick [kPa].
  double advance(double command_kpa) noexcept;

 private:
  model::RegulatedPressure<double> regulated_;
  double tick_s_;
  double filling_share_, venting_share_;  ///< share of the error beyond the overlap that filling removes in
                                          ///< one tick, and share that venting removes
};

}  // namespace softgrip::control
