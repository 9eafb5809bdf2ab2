#pragma once
// The command that makes a valve bring its pressure somewhere one tick from now.

#include <optional>

#include "control/feedforward/regulator_inverse.h"
#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// Of a valve whose command is held for a tick:
///
///   behind a lag:  u = p[k-1] + (p[k] - p[k-1]) / (1 - exp(-T/tau)): the exact inverse of a first-order lag
///                  under a held input, so lead and the hold's half sample are one; tau is that of the
///                  direction in which the pressure goes, and of several lags in series their sum;
///   a regulator:   the command that takes its spool through the overlap, less what its integral does
///                  already (RegulatorInverse), if the valve has no lag in addition;
///   without one:   u = (p[k-1] + p[k]) / 2, the middle of the stretch, for the same half sample;
///   a dead band before it: u and half the band in the direction of travel. One behind it is left alone.
class ValveInverse {
 public:
  /// @param model  a whole one.
  /// @param tick_s  > 0.
  ValveInverse(const model::Model& model, double tick_s);

  /// Takes over the state of the chain of valve_of() the same model.
  void take_over(const model::Chain<double>& valve) noexcept;

  /// The command under which the pressure, now at `now_kpa`, is at `next_kpa` at the end of the tick; where
  /// no port opens far enough, one under which it is open as far as it gets. Changes nothing.
  [[nodiscard]] double command_for(double now_kpa, double next_kpa) const noexcept;
  /// Moves on by one tick from `now_kpa`; the pressure at its end [kPa].
  double advance(double now_kpa, double command_kpa) noexcept;

  /// Returns the time constant of the lags, from `now_kpa` towards `pressure_kpa` [s]; 0 without a lag.
  [[nodiscard]] double time_constant_s(double now_kpa, double pressure_kpa) const noexcept {
    return lag_towards(now_kpa, pressure_kpa).time_constant_s;
  }

 private:
  struct Lag {
    double time_constant_s = 0;
    double share = 1;  ///< of the way to the command that it goes in a tick
  };
  [[nodiscard]] const Lag& lag_towards(double now_kpa, double pressure_kpa) const noexcept {
    return pressure_kpa >= now_kpa ? filling_ : venting_;
  }

  double tick_s_;
  Lag filling_, venting_;
  std::optional<RegulatorInverse> regulator_;  ///< in the place of the lag
  double half_band_kpa_ = 0;
  double behind_band_kpa_ = 0;  ///< the command as it comes out of the dead band
};

}  // namespace softgrip::control
