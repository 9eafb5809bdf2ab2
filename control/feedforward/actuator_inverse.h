#pragma once
// The pressure that brings everything behind the valve to a displacement one tick from now.

#include <array>

#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// The displacement at the end of a tick rises with the pressure at its end as long as the instantaneous gain
/// is positive (check_feedforward() sees to it), so that one pressure solves it: a Newton iteration on the
/// implicit equation, kept inside a bracket. The explicit "multiplicative" form, which computes the pressure
/// from the hysteresis state of the tick before, is a fixed-point iteration with loop gain beta/alpha and is
/// not used: it diverges from 1 on (tests/control/feedforward/actuator_inverse_test.cpp shows it).
class ActuatorInverse {
 public:
  /// @param body  a model of what the chain has behind the valve (see body_of()).
  ActuatorInverse(const model::Model& body, double tick_s);

  struct Solution {
    double pressure_kpa = 0;
    bool reached = true;  ///< false: a bound of the bracket is the nearest
  };
  /// The pressure in [lower_kpa, upper_kpa] for `displacement_mm` behind the load at the end of the next
  /// tick, to 1e-11 mm. Changes nothing.
  [[nodiscard]] Solution solve(double displacement_mm, double lower_kpa, double upper_kpa) const noexcept;

  /// Moves on by one tick, straight to `pressure_kpa`.
  void advance(double pressure_kpa) noexcept;
  /// Takes over the state of a chain of the same model, at `pressure_kpa`.
  void take_over(const model::Chain<double>& body, double pressure_kpa) noexcept;

  /// The displacement behind the load one tick from now if the pressure went straight to `pressure_kpa`.
  [[nodiscard]] double displacement_at(double pressure_kpa) const noexcept;
  [[nodiscard]] double displacement_mm() const noexcept { return body_.after(model::Station::load); }
  [[nodiscard]] double pressure_kpa() const noexcept { return past_kpa_[0]; }

 private:
  double tick_s_;
  model::Chain<double> body_;
  std::array<double, 3> past_kpa_{};  ///< newest first: the next is guessed from their parabola
};

}  // namespace softgrip::control
