#pragma once
// Finds the command with which a valve reaches a given pressure after one tick.
// Finds the command with which a pressure regulator reaches a given pressure after one tick.

#include <optional>

#include "model/chain.h"
#include "model/model.h"
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

/// Computes the command u for the pressure p, for a valve whose command is held for a tick with the period T.
/// The formula depends on the blocks of the valve:
///
///   one lag:        u = p[k-1] + (p[k] - p[k-1]) / (1 - exp(-T/tau)), the exact inverse of a first-order lag
///                   under a held input. It contains the lead and compensates half a sample of the hold. tau
///                   is the time constant for the direction of the change.
///   several lags:   the same formula, where tau is the sum of their time constants.
///   no lag:         u = (p[k-1] + p[k]) / 2, the middle of the change, which also compensates half a sample.
///   a regulator as the only lag: the command that moves the regulator's spool through the overlap, minus the
///                   effect of its integral (RegulatorInverse).
///   a dead band before one of these: u plus half of the band in the direction of the change. A dead band
///                   after them is ignored.
class ValveInverse {
 public:
  /// @param model  the complete model of the finger.
  /// @param tick_s  duration of a tick [s], > 0.
  ValveInverse(const model::Model& model, double tick_s);

  /// Copies the state of `valve`. `valve` is a chain of the model that valve_of() returns for the model of
  /// the constructor.
  void take_over(const model::Chain<double>& valve) noexcept;

  /// Returns the command for which the pressure changes from `now_kpa` to `next_kpa` at the end of the tick.
  /// If no opening of the port is large enough for this change, returns a command that opens the port fully.
  /// Does not change the state.
  [[nodiscard]] double command_for(double now_kpa, double next_kpa) const noexcept;
  /// Advances by one tick from the pressure `now_kpa` and returns the pressure at the end of the tick [kPa].
  double advance(double now_kpa, double command_kpa) noexcept;

  /// Returns the time constant of the lags for a change from `now_kpa` towards `pressure_kpa` [s]; 0 without
  /// a lag.
  [[nodiscard]] double time_constant_s(double now_kpa, double pressure_kpa) const noexcept {
    return lag_towards(now_kpa, pressure_kpa).time_constant_s;
  }

 private:
  struct Lag {
    double time_constant_s = 0;
    double share = 1;  ///< share of the distance to the command that the pressure covers in a tick
  };
  [[nodiscard]] const Lag& lag_towards(double now_kpa, double pressure_kpa) const noexcept {
    return pressure_kpa >= now_kpa ? filling_ : venting_;
  }

  double tick_s_;
  Lag filling_, venting_;
  std::optional<RegulatorInverse> regulator_;  ///< inverse of the regulator; empty if the valve has no
                                               ///< regulator, or also has another lag
  double half_band_kpa_ = 0;
  double behind_band_kpa_ = 0;  ///< pressure command behind the valve's dead band
};

}  // namespace softgrip::control
