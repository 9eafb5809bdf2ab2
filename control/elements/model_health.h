#pragma once
// Detects that the model no longer describes the finger. The criterion is the residual: the reading minus the
// output of the model that runs in parallel.
//
// The residual of a healthy model is not white: parameter errors of a few percent cause errors that follow
// the motion. The residual is modelled as the sum of a slow error and white noise of the sensor. The slow
// error is an Ornstein-Uhlenbeck process with standard deviation model_error_mm and correlation exp(-t /
// correlation_time_s). Readings are averaged over interval_s. A Kalman filter of this process turns the
// averages into innovations, which are independent and have unit variance if the residual has these
// properties. A two-sided CUSUM (Page, Biometrika 41, 1954) accumulates the innovations. Its threshold is
// computed with Siegmund's formula (Sequential Analysis, 1985, chapter 2) from the required mean time between
// false alarms. An error of the model raises an alarm if it is larger than model_error_mm or slower than
// correlation_time_s.

#include <cstdint>
#include <string_view>

namespace softgrip::control {

enum class HealthState : std::uint8_t {
  unknown,  ///< the model has not been observed yet
  healthy,
  suspect,  ///< the residual drifts more than that of a healthy model; the model should be fitted again soon
  unfit,    ///< rms_mm() exceeds unfit_mm, the tolerance of grip detection and of the feedforward
};
/// Returns the name of a state: "unknown", "healthy", "suspect" or "unfit".
[[nodiscard]] std::string_view name_of(HealthState state) noexcept;

/// Properties of the residual of a healthy model, and the limits for warnings. The defaults were tested on
/// the simulated finger with models whose parameters are wrong. The test used 40 models for each size of the
/// parameter error, and five cycles of a 13 +- 7 mm sine. The number of models that become suspect or unfit
/// is 0 for parameter errors up to 5 %. The number is 5 for errors up to 10 %, and 23 for errors up to 20 %
/// (checked by tests/control/tuning/tracking_run_test.cpp).
struct ModelHealthSettings {
  double model_error_mm = 0.4;      ///< > 0; standard deviation of the slow error
  double correlation_time_s = 4.0;  ///< > 0; correlation time of the slow error
  double noise_mm = 0.05;           ///< > 0; standard deviation of the noise of one reading
  double interval_s = 1.0;          ///< > 0; time over which the readings are averaged before each decision
  double allowance_sigma = 0.5;     ///< > 0; half of the shift of the innovations that must be detected, in
                                    ///< standard deviations
  /// > 0; mean time between false alarms of a healthy model. The decision threshold is computed from this
  /// time.
  double false_alarm_interval_s = 3.6e6;
  /// Limit for ModelHealth::rms_mm(), > 0. Above this limit, the model is unfit.
  double unfit_mm = 1.5;
  double unfit_window_s = 5;  ///< > 0; time constant of the mean square of the interval averages
};

/// Returns the mean number of independent standard normal values until a two-sided CUSUM reaches `threshold`.
/// The CUSUM starts at 0, and `allowance` is subtracted from each value. The result is Siegmund's
/// approximation. Its error is a few percent for run lengths of 50 and more.
[[nodiscard]] double cusum_run_length(double allowance, double threshold) noexcept;
/// Returns the threshold for which cusum_run_length() returns `run_length`. `run_length` must be at least 2.
[[nodiscard]] double cusum_threshold(double allowance, double run_length) noexcept;

/// Turns averages of a residual over intervals into innovations. The innovations are independent and standard
/// normal if the residual has the properties in the settings. The filter is a Kalman filter whose process
/// noise correlates with its observation noise. The two correlate because the average over an interval and
/// the state at its end depend on the same noise.
class ResidualWhitener {
 public:
  explicit ResidualWhitener(const ModelHealthSettings& settings) noexcept;
  /// Restarts the filter after a gap in the readings. After the restart, the filter knows only the variance
  /// of the slow error, not its value.
  void reset() noexcept;
  /// Returns the innovation of one interval in standard deviations; `count` is the number of averaged
  /// readings.
  [[nodiscard]] double next(double average_mm, double count) noexcept;

 private:
  double keep_, observe_, process_variance_, average_variance_, shared_covariance_, slow_variance_;
  double noise_variance_;
  double estimate_mm_ = 0;
  double variance_;
};

/// Monitors the model of one channel.
class ModelHealth {
 public:
  ModelHealth(const ModelHealthSettings& settings, double tick_s) noexcept;

  /// Discards all residuals that were observed so far.
  void reset() noexcept;
  /// Processes a tick with a valid reading in free motion. Returns true if the state changed.
  bool observe(double residual_mm) noexcept;
  /// Processes a tick that has no valid reading in free motion. Returns true if the state changed. An
  /// interval with readings in less than half of its ticks is ignored.
  bool skip() noexcept;

  [[nodiscard]] HealthState state() const noexcept { return state_; }
  /// Returns the root mean square of the residual's interval averages, weighted with exp(-t / unfit_window_s)
  /// [mm].
  [[nodiscard]] double rms_mm() const noexcept;

 private:
  bool judge_interval() noexcept;
  bool end_tick() noexcept;

  ModelHealthSettings settings_;
  ResidualWhitener whitener_;
  double threshold_ = 0;
  double forget_ = 0;  ///< weight of one interval in the mean square of the averages
  std::uint32_t ticks_per_interval_ = 1;
  std::uint32_t ticks_ = 0;
  std::uint32_t observed_ = 0;
  double sum_mm_ = 0;
  double up_ = 0;    ///< CUSUM of positive innovations, each reduced by the allowance
  double down_ = 0;  ///< CUSUM of negative innovations, each reduced by the allowance
  double mean_square_mm2_ = 0;
  bool alarmed_ = false;
  HealthState state_ = HealthState::unknown;
};

}  // namespace softgrip::control
