#pragma once
// Implements a PID controller with two degrees of freedom. Its anti-windup uses the command that was sent
// after the limits.
//
//   request = feedforward + kp (b r - y) + I - kd d(y filtered)/dt,   dI/dt = ki (r - y)
//
// with the reference r, the reading y and the setpoint weight b. Discretisation: trapezoidal rule for the
// integral; ramp-invariant for the derivative, which is exact if the measurement is linear between samples
// (Åström and Wittenmark, Computer-Controlled Systems, 3rd ed. 1997, chapters 8.2 and 8.5; Åström and
// Hägglund, Advanced PID Control, 2006, chapter 13).

#include <cstdint>

#include "base/enum_table.h"

namespace softgrip::control {

/// Method that prevents integrator windup. Windup occurs while the limits keep the command away from the
/// request.
enum class AntiWindup : std::uint8_t {
  none,              ///< no protection: the integrator continues (for comparisons with the other methods)
  conditional,       ///< the integrator stops while it would move a limited request further beyond the limit
  back_calculation,  ///< the difference between request and limited command drives the integrator back, with
                     ///< the time constant tracking_time_s
};

/// Names of the methods in rig files.
inline constexpr auto anti_windup_names =
    enum_names<AntiWindup>({{AntiWindup::none, "none"},
                            {AntiWindup::conditional, "conditional"},
                            {AntiWindup::back_calculation, "back_calculation"}});

struct PidSettings {
  double kp_kpa_per_mm = 0;
  double ki_kpa_per_mm_s = 0;
  double kd_kpa_s_per_mm = 0;
  double derivative_filter_s = 0.02;  ///< time constant of the first-order filter of the derivative; >= 0
  double setpoint_weight = 1;         ///< setpoint weight b, 0 to 1: factor of the reference in the
                                      ///< proportional part
  AntiWindup anti_windup = AntiWindup::back_calculation;
  double tracking_time_s = 0.5;  ///< > 0; time constant with which back_calculation drives the integrator
                                 ///< back
};

/// One PID controller. In each tick, the caller calls step() to get the request, applies the limits to the
/// request, and passes the limited command to sent().
class Pid {
 public:
  Pid(const PidSettings& settings, double tick_s) noexcept;

  /// Makes the request of the next step() equal to `command_kpa`, for any control error and any feedforward.
  /// To do so, the integrator absorbs the difference. Call this function at a start, when the mode changes
  /// from hold or pressure to displacement, and when the feedforward changes. A command that is not finite is
  /// ignored.
  void align(double command_kpa) noexcept;

  /// Returns the feedback part of the request [kPa]. The request is the sum of feedforward_kpa and the
  /// feedback. `error_reference_mm` is the reference at the time at which `measurement_mm` was sampled. If an
  /// argument is not finite, the function does the same as hold().
  [[nodiscard]] double step(double error_reference_mm, double measurement_mm,
                            double feedforward_kpa) noexcept;

  /// Processes a tick without a usable measurement, or a tick in which the feedback is held on purpose.
  /// Returns the feedback of the last tick; the integrator and the derivative do not change. The first call
  /// after align() returns the feedback that keeps the command unchanged. The next step() continues from this
  /// feedback. The result is finite even if the feedforward is not. A feedforward that is not finite does not
  /// end the effect of align().
  [[nodiscard]] double hold(double feedforward_kpa) noexcept;

  /// Receives the command that was sent after the limits. The anti-windup acts on the difference between this
  /// command and the last request. The difference can come from the pressure range, from the slew limits or
  /// from a feedforward outside the pressure range. The function ignores a command that is not finite, and a
  /// command after a request that is not finite.
  void sent(double command_kpa) noexcept;

  [[nodiscard]] double integral_kpa() const noexcept { return integral_kpa_; }

 private:
  [[nodiscard]] bool aligns() const noexcept {
    return memory_ == Memory::aligning || memory_ == Memory::aligned_ahead;
  }
  [[nodiscard]] double immediate_kpa(double reference_mm, double measurement_mm) const noexcept;

  PidSettings settings_;
  double tick_s_;
  double filter_keep_;     ///< share of the derivative filter's state that remains per tick
  double tracking_share_;  ///< for back_calculation: share of the difference between request and limited
                           ///< command that is subtracted from the integral in each tick
  double integral_kpa_ = 0;
  double rate_mm_per_s_ = 0;  ///< filtered derivative of the measurement
  double last_error_mm_ = 0;
  double last_measurement_mm_ = 0;
  double feedback_kpa_ = 0;
  double request_kpa_ = 0;
  double increment_kpa_ = 0;  ///< change of the integral in the last step
  double align_to_kpa_ = 0;
  /// The state from which the next step() computes the feedback.
  enum class Memory : std::uint8_t {
    none,           ///< only the integral; no earlier measurement exists for the derivative and the
                    ///< trapezoidal rule
    measured,       ///< the integral and the measurement of the last step
    aligning,       ///< the command that align() received
    aligned_ahead,  ///< the command that align() received, after hold() has kept this command unchanged
  };
  Memory memory_ = Memory::none;
};

}  // namespace softgrip::control
