#pragma once
// Finds the command with which a valve reaches a given pressure after one tick.

#include <optional>

#include "control/feedforward/regulator_inverse.h"
#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// Computes the command u for the pressure p, for a valve whose command is held for a tick with the period T.
/// The formula depends on the blocks of the valve:
///
///   one lag:        u = p[k-1] + (p[k] - p[k-1]) / (1 - exp(-T/tau)), the exact inverse of a first-order lag
///                   under a held input. It contains the lead and compensates half a sample of the hold. tau
///                   is the time constant for the direction of the change.
///   several lags:   the same formula, where tau is the sum of their time constants.
///   no lag:         u = (p[k-1] + p[k]) / 2, the middle of the change, which also compensates half a sample.
///   a regulator without a lag: the command that moves the regulator's spool through the overlap, minus the
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
  std::optional<RegulatorInverse> regulator_;  ///< inverse of the regulator, used if the valve has no lag
  double half_band_kpa_ = 0;
  double behind_band_kpa_ = 0;  ///< pressure command behind the valve's dead band
};

}  // namespace softgrip::control
