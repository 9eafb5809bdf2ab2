#include "control/elements/pid.h"

#include <cmath>

#include "control/elements/lag_share.h"

namespace softgrip::control {

Pid::Pid(const PidSettings& settings, double tick_s) noexcept
    : settings_(settings),
      tick_s_(tick_s),
      filter_keep_(settings.derivative_filter_s > 0 ? std::exp(-tick_s / settings.derivative_filter_s) : 0),
      tracking_share_(lag_share(tick_s, settings.tracking_time_s)) {}

void Pid::align(double command_kpa) noexcept {
  if (!std::isfinite(command_kpa)) return;
  memory_ = Memory::aligning;
  rate_mm_per_s_ = 0;
  align_to_kpa_ = command_kpa;
}

double Pid::immediate_kpa(double reference_mm, double measurement_mm) const noexcept {
  return settings_.kp_kpa_per_mm * (settings_.setpoint_weight * reference_mm - measurement_mm) -
         settings_.kd_kpa_s_per_mm * rate_mm_per_s_;
}

double Pid::step(double error_reference_mm, double measurement_mm, double feedforward_kpa) noexcept {
  // A value that is not finite would remain in the integral and in the derivative.
  const double error_mm = error_reference_mm - measurement_mm;
  if (!std::isfinite(error_mm) || !std::isfinite(feedforward_kpa)) return hold(feedforward_kpa);
  increment_kpa_ = 0;
  if (memory_ == Memory::measured) {
    const double rate = (measurement_mm - last_measurement_mm_) / tick_s_;
    rate_mm_per_s_ = filter_keep_ * rate_mm_per_s_ + (1 - filter_keep_) * rate;
    increment_kpa_ = settings_.ki_kpa_per_mm_s * tick_s_ * 0.5 * (error_mm + last_error_mm_);
  }
  const double immediate = immediate_kpa(error_reference_mm, measurement_mm);
  if (aligns()) {
    integral_kpa_ = align_to_kpa_ - feedforward_kpa - immediate;
    increment_kpa_ = 0;
  } else {
    integral_kpa_ += increment_kpa_;
  }
  memory_ = Memory::measured;
  last_error_mm_ = error_mm;
  last_measurement_mm_ = measurement_mm;
  feedback_kpa_ = immediate + integral_kpa_;
  request_kpa_ = feedforward_kpa + feedback_kpa_;
  return feedback_kpa_;
}

double Pid::hold(double feedforward_kpa) noexcept {
  if (memory_ == Memory::aligning && std::isfinite(feedforward_kpa)) {
    feedback_kpa_ = align_to_kpa_ - feedforward_kpa;
    memory_ = Memory::aligned_ahead;
  } else if (memory_ == Memory::measured) {
    memory_ = Memory::none;
  }
  increment_kpa_ = 0;
  request_kpa_ = feedforward_kpa + feedback_kpa_;
  return feedback_kpa_;
}

void Pid::sent(double command_kpa) noexcept {
  if (!std::isfinite(command_kpa)) return;
  if (aligns()) align_to_kpa_ = command_kpa;
  const double cut_kpa = command_kpa - request_kpa_;
  if (!std::isfinite(cut_kpa)) return;
  // The anti-windup changes the integral. If the integral gain is 0, nothing would ever remove this change.
  // Therefore, the anti-windup is not applied.
  if (cut_kpa == 0 || settings_.ki_kpa_per_mm_s == 0) return;
  switch (settings_.anti_windup) {
    case AntiWindup::none:
      break;
    case AntiWindup::conditional:
      if (increment_kpa_ * cut_kpa < 0) integral_kpa_ -= increment_kpa_;
      break;
    case AntiWindup::back_calculation:
      integral_kpa_ += tracking_share_ * cut_kpa;
      break;
  }
  increment_kpa_ = 0;
}

}  // namespace softgrip::control
