#pragma once
// Finds the pressure at the actuator with which the blocks after the valve reach a given displacement after
// one tick.

#include <array>

#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// Finds the pressure with a Newton iteration that solves the implicit equation inside a bracket.
/// check_feedforward() ensures that the instantaneous gain is positive. Therefore, the displacement at the
/// end of a tick increases with the pressure at the end of the tick, and the solution is unique. The explicit
/// "multiplicative" form computes the pressure from the hysteresis state of the last tick. This class does
/// not use the explicit form. The explicit form is a fixed-point iteration with the loop gain beta/alpha, and
/// diverges for a loop gain of 1 or more (tests/control/feedforward/actuator_inverse_test.cpp).
class ActuatorInverse {
 public:
  /// @param body  a model of the chain after the valve (see body_of()).
  ActuatorInverse(const model::Model& body, double tick_s);

  struct Solution {
    double pressure_kpa = 0;
    bool reached = true;  ///< false: the bracket contains no solution, so `pressure_kpa` is the nearest bound
  };
  /// Returns the pressure in [lower_kpa, upper_kpa] for which the output of the load is `displacement_mm` at
  /// the end of the next tick. The error of the displacement is at most 1e-11 mm. `displacement_mm` must be
  /// finite. Does not change the state.
  [[nodiscard]] Solution solve(double displacement_mm, double lower_kpa, double upper_kpa) const noexcept;

  /// Advances by one tick in which the pressure changes linearly to `pressure_kpa`.
  void advance(double pressure_kpa) noexcept;
  /// Copies the state of `body` at the pressure `pressure_kpa`. `body` must be a chain of the model that the
  /// constructor received.
  void take_over(const model::Chain<double>& body, double pressure_kpa) noexcept;

  /// Returns the displacement at the output of the load after one tick in which the pressure changes linearly
  /// to `pressure_kpa`.
  [[nodiscard]] double displacement_at(double pressure_kpa) const noexcept;
  [[nodiscard]] double displacement_mm() const noexcept { return body_.after(model::Station::load); }
  [[nodiscard]] double pressure_kpa() const noexcept { return past_kpa_[0]; }

 private:
  double tick_s_;
  model::Chain<double> body_;
  std::array<double, 3> past_kpa_{};  ///< last three pressures, newest first; the parabola through them gives
                                      ///< the next initial guess
};

}  // namespace softgrip::control
