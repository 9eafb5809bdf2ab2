#pragma once
// PID controller with two degrees of freedom that uses the command that was really sent.
//
//   request = feedforward + kp (b r - y) + I - kd d(y filtered)/dt,   dI/dt = ki (r - y)
//
// Discretisation: trapezoidal rule for the integral; ramp-invariant for the derivative, which is exact if the
// measurement is linear between samples (Åström and Wittenmark, Computer-Controlled Systems, 3rd ed. 1997,
// chapters 8.2 and 8.5; Åström and Hägglund, Advanced PID Control, 2006, chapter 13).

#include <cstdint>

namespace softgrip::control {

/// Method that prevents integrator windup while the command cannot follow the request.
enum class AntiWindup : std::uint8_t {
  none,              ///< the integrator continues: for comparison only
  conditional,       ///< the integrator stops while its increment would move a limited request further beyond
                     ///< the limit
  back_calculation,  ///< the part that the limits remove drives the integrator back within tracking_time_s
};

struct PidSettings {
  double kp_kpa_per_mm = 0;
  double ki_kpa_per_mm_s = 0;
  double kd_kpa_s_per_mm = 0;
  double derivative_filter_s = 0.02;  ///< time constant of the first-order filter of the derivative; >= 0
  double setpoint_weight = 1;         ///< b: share of the reference in the proportional part, 0 to 1
  AntiWindup anti_windup = AntiWindup::back_calculation;
  double tracking_time_s = 0.5;  ///< for back_calculation; > 0
};

/// One PID controller. In each tick, the caller calls step() to get the request, applies the limits, and
/// passes the limited command to sent().
class Pid {
 public:
  Pid(const PidSettings& settings, double tick_s) noexcept;

  /// Makes the request of the next step() equal to `command_kpa`, regardless of the error and the
  /// feedforward: the integrator absorbs the difference. Call this function at a start, at a change from hold
  /// or pressure to displacement, and for a new feedforward.
  void align(double command_kpa) noexcept;

  /// Returns the feedback part of the request [kPa]; the request is the sum of feedforward_kpa and this part.
  /// `error_reference_mm` is the reference at the time at which `measurement_mm` was sampled.
  [[nodiscard]] double step(double error_reference_mm, double measurement_mm,
                            double feedforward_kpa) noexcept;

  /// Processes a tick without a usable measurement, or with the feedback held on purpose. The last feedback
  /// is kept, and the integrator and the derivative pause. After align(), the feedback is the value that
  /// continues the command, and the next step() continues from there.
  [[nodiscard]] double hold(double feedforward_kpa) noexcept;

  /// Receives the command that remains of the last request after the limits. The anti-windup acts on the
  /// difference between this command and the request. The difference can come from the pressure range, the
  /// slew limits or a feedforward beyond these limits.
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
  double tracking_share_;  ///< back-calculation: share of the part removed by the limits that is taken from
                           ///< the integral per tick
  double integral_kpa_ = 0;
  double rate_mm_per_s_ = 0;  ///< filtered derivative of the measurement
  double last_error_mm_ = 0;
  double last_measurement_mm_ = 0;
  double feedback_kpa_ = 0;
  double request_kpa_ = 0;
  double increment_kpa_ = 0;  ///< increase of the integral in the last step
  double align_to_kpa_ = 0;
  /// The state from which the next step() continues.
  enum class Memory : std::uint8_t {
    none,           ///< the integral alone: there is no earlier measurement for the derivative and the
                    ///< trapezoidal rule
    measured,       ///< the last measurement
    aligning,       ///< the command of align()
    aligned_ahead,  ///< the command of align(), after a hold() that continued it
  };
  Memory memory_ = Memory::none;
};

}  // namespace softgrip::control
