#pragma once
// Does the model still describe the finger? Watches the residual of the model that runs beside the finger.

#include <cstdint>

namespace softgrip::control {

enum class HealthState : std::uint8_t {
  unknown,  ///< nothing was observed yet
  healthy,
  suspect,  ///< the residual drifts more than a healthy model's: calibrate soon
  unfit,    ///< the residual is larger than grip detection and feedforward can stand
};
[[nodiscard]] const char* name_of(HealthState state) noexcept;

/// What a healthy residual looks like, and when to tell. A healthy residual is the sum of a slow model error
/// (standard deviation model_error_mm, correlation exp(-t/correlation_time_s)) and white sensor noise.
struct ModelHealthSettings {
  double model_error_mm = 0.2;      ///< > 0
  double correlation_time_s = 1.0;  ///< > 0
  double noise_mm = 0.05;           ///< > 0; of one reading
  double interval_s = 0.5;          ///< > 0; the residual is averaged over this long before it is judged
  double allowance_sigma = 0.5;     ///< > 0; half the shift to be found, in standard deviations per interval
  /// > 0; mean time between false alarms of a healthy model. The decision threshold follows from it.
  double false_alarm_interval_s = 3.6e6;
  double unfit_mm = 3;        ///< > 0; root mean square over unfit_window_s beyond which it is unfit
  double unfit_window_s = 5;  ///< > 0
};

}  // namespace softgrip::control
