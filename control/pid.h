#pragma once
// PID in two degrees of freedom that knows which command really went out.

#include <cstdint>

namespace softgrip::control {

/// How the integrator is kept from winding up while the command cannot follow the request.
enum class AntiWindup : std::uint8_t {
  none,              ///< it integrates on: for comparison only
  conditional,       ///< it stops while the request is cut off and the error pushes further into the cut
  back_calculation,  ///< what was cut off drives it back within tracking_time_s
};

struct PidSettings {
  double kp_kpa_per_mm = 0;
  double ki_kpa_per_mm_s = 0;
  double kd_kpa_s_per_mm = 0;
  double derivative_filter_s = 0.02;  ///< time constant of the first-order filter of the derivative; >= 0
  double setpoint_weight = 1;         ///< b: share of the reference in the proportional part, 0 to 1
  AntiWindup anti_windup = AntiWindup::back_calculation;
  double tracking_time_s = 0.5;  ///< of back_calculation; > 0
};

}  // namespace softgrip::control
