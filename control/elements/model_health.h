#pragma once
// Does the model still describe the finger? Watches the residual of the model that runs beside the finger.
//
// The residual of a healthy model is not white: parameters that are off by a few percent give errors that
// follow the motion. It is taken as the sum of a slow error (an Ornstein-Uhlenbeck process: standard
// deviation model_error_mm, correlation exp(-t / correlation_time_s)) and white noise of the sensor. Readings
// are averaged over interval_s; a Kalman filter of exactly that process turns the averages into innovations,
// which are independent and of unit variance as long as the assumption holds; a two-sided CUSUM (Page,
// Biometrika 41, 1954) adds them up. Its threshold comes from the wanted mean time between false alarms by
// Siegmund's formula (Sequential Analysis, 1985, chapter 2), so the rate is stated, for residuals that are as
// assumed; a model error that is larger or slower than assumed alarms more often, which is what it is for.

#include <array>
#include <cstddef>
#include <cstdint>

namespace softgrip::control {

enum class HealthState : std::uint8_t {
  unknown,  ///< nothing was observed yet
  healthy,
  suspect,  ///< the residual drifts more than a healthy model's: calibrate soon
  unfit,    ///< the residual exceeds the tolerance of grip detection and feedforward
};
[[nodiscard]] const char* name_of(HealthState state) noexcept;

/// Properties of a healthy residual, and the limits for warnings. With the defaults, 40 models of the bench
/// twin with wrong parameters were tested for five cycles of a 13 +- 7 mm sine. With errors up to 5 % none is
/// suspect, up to 10 % five, up to 20 % twenty-three (checked by tests/control/tuning/tracking_run_test.cpp).
struct ModelHealthSettings {
  double model_error_mm = 0.4;      ///< > 0
  double correlation_time_s = 4.0;  ///< > 0
  double noise_mm = 0.05;           ///< > 0; of one reading
  double interval_s = 1.0;          ///< > 0; the residual is averaged over this long before it is judged
  double allowance_sigma = 0.5;     ///< > 0; half the shift to be found, in standard deviations per interval
  /// > 0; mean time between false alarms of a healthy model. The decision threshold follows from it.
  double false_alarm_interval_s = 3.6e6;
  double unfit_mm = 1.5;      ///< > 0; root mean square over unfit_window_s beyond which it is unfit
  double unfit_window_s = 5;  ///< > 0
};

/// Mean number of independent standard normal values until a two-sided CUSUM with this allowance first
/// reaches `threshold`, from zero. Siegmund's approximation: within a few percent from 50 on.
[[nodiscard]] double cusum_run_length(double allowance, double threshold) noexcept;
/// The threshold whose cusum_run_length() is `run_length` (at least 2).
[[nodiscard]] double cusum_threshold(double allowance, double run_length) noexcept;

/// Turns averages of a residual over intervals into independent standard normal innovations, if the residual
/// is what the settings say: a Kalman filter with the process noise correlated to the observation's, since
/// the average over an interval and the state at its end share their history.
class ResidualWhitener {
 public:
  explicit ResidualWhitener(const ModelHealthSettings& settings) noexcept;
  /// After a gap: nothing is known of the slow error but its variance.
  void reset() noexcept;
  /// The innovation of one interval, in standard deviations; `count` readings were averaged.
  [[nodiscard]] double next(double average_mm, double count) noexcept;

 private:
  double keep_, observe_, process_variance_, average_variance_, shared_covariance_, slow_variance_;
  double noise_variance_;
  double estimate_mm_ = 0;
  double variance_;
};

/// The monitor of one channel.
class ModelHealth {
 public:
  ModelHealth(const ModelHealthSettings& settings, double tick_s) noexcept;

  /// Forgets what it saw.
  void reset() noexcept;
  /// One tick with a valid reading in free motion. Returns true if the state changed.
  bool observe(double residual_mm) noexcept;
  /// One tick without: the interval under way is dropped if too little of it is left.
  bool skip() noexcept;

  [[nodiscard]] HealthState state() const noexcept { return state_; }
  /// Root mean square of the interval averages over about unfit_window_s [mm].
  [[nodiscard]] double rms_mm() const noexcept;

 private:
  bool judge_interval() noexcept;
  bool end_tick() noexcept;

  ModelHealthSettings settings_;
  ResidualWhitener whitener_;
  double threshold_ = 0;
  double forget_ = 0;  ///< share of an interval in the mean square
  std::uint32_t ticks_per_interval_ = 1;
  std::uint32_t ticks_ = 0;
  std::uint32_t observed_ = 0;
  double sum_mm_ = 0;
  double up_ = 0;    ///< CUSUM of innovations above the allowance
  double down_ = 0;  ///< of those below
  double mean_square_mm2_ = 0;
  bool alarmed_ = false;
  HealthState state_ = HealthState::unknown;
};

}  // namespace softgrip::control
