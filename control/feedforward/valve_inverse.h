#pragma once
// Finds the command for which a valve reaches a pressure one tick from now.

#include <optional>

#include "control/feedforward/regulator_inverse.h"
#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// Inverse of a valve whose command is held for a tick, with the period T:
///
///   behind a lag:  u = p[k-1] + (p[k] - p[k-1]) / (1 - exp(-T/tau)), the exact inverse of a first-order lag
///                  under a held input, which contains the lead and compensates half a sample of the hold.
///                  tau is the value for the direction of the change; for several lags in series, the sum of
///                  theirs;
///   a regulator:   the command that moves its spool through the overlap, minus the effect of its integral
///                  (RegulatorInverse), if the valve has no lag in addition;
///   without a lag: u = (p[k-1] + p[k]) / 2, the middle of the change, which compensates half a sample too;
///   with a dead band before it: u plus half of the band in the direction of the change. A dead band after it
///                  is ignored.
class ValveInverse {
 public:
  /// @param model  the complete model.
  /// @param tick_s  > 0.
  ValveInverse(const model::Model& model, double tick_s);

  /// Copies the state of the chain valve_of() of the same model.
  void take_over(const model::Chain<double>& valve) noexcept;

  /// Returns the command for which the pressure changes from `now_kpa` to `next_kpa` at the end of the tick.
  /// If no port opens far enough for this change, returns a command that opens the port fully. Does not
  /// change the state.
  [[nodiscard]] double command_for(double now_kpa, double next_kpa) const noexcept;
  /// Advances by one tick from `now_kpa` and returns the pressure at its end [kPa].
  double advance(double now_kpa, double command_kpa) noexcept;

  /// Returns the time constant of the lags, from `now_kpa` towards `pressure_kpa` [s]; 0 without a lag.
  [[nodiscard]] double time_constant_s(double now_kpa, double pressure_kpa) const noexcept {
    return lag_towards(now_kpa, pressure_kpa).time_constant_s;
  }

 private:
  struct Lag {
    double time_constant_s = 0;
    double share = 1;  ///< share of the distance to the command that is covered in a tick
  };
  [[nodiscard]] const Lag& lag_towards(double now_kpa, double pressure_kpa) const noexcept {
    return pressure_kpa >= now_kpa ? filling_ : venting_;
  }

  double tick_s_;
  Lag filling_, venting_;
  std::optional<RegulatorInverse> regulator_;  ///< used in place of the lag
  double half_band_kpa_ = 0;
  double behind_band_kpa_ = 0;  ///< the command after the dead band
};

}  // namespace softgrip::control
