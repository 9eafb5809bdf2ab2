#include "control/elements/model_health.h"

#include <algorithm>
#include <cmath>

#include "base/enum_table.h"
#include "control/elements/lag_share.h"

namespace softgrip::control {
namespace {

/// A model becomes unfit when its error exceeds unfit_mm, and fit again when its error falls below this share
/// of unfit_mm. The difference prevents frequent changes of the state.
constexpr double recovery_share = 0.7;
/// After an alarm, the CUSUM is limited to this multiple of its threshold. Without this limit, a model that
/// fits the finger again would stay in alarm for a long time.
constexpr double cap_share = 1.5;
/// Siegmund's correction of the CUSUM threshold. This correction compensates the overshoot of the discrete
/// random walk over the threshold.
constexpr double overshoot = 1.166;

constexpr auto state_names = enum_names<HealthState>({{HealthState::unknown, "unknown"},
                                                      {HealthState::healthy, "healthy"},
                                                      {HealthState::suspect, "suspect"},
                                                      {HealthState::unfit, "unfit"}});

}  // namespace

std::string_view name_of(HealthState state) noexcept {
  return state_names[state];
}

double cusum_run_length(double allowance, double threshold) noexcept {
  const double reach = 2 * allowance * (threshold + overshoot);
  const double one_sided = (std::expm1(reach) - reach) / (2 * allowance * allowance);
  return one_sided / 2;
}

double cusum_threshold(double allowance, double run_length) noexcept {
  double lower = 0;
  double upper = 1;
  while (cusum_run_length(allowance, upper) < run_length && upper < 1e6) upper *= 2;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (lower + upper);
    (cusum_run_length(allowance, middle) < run_length ? lower : upper) = middle;
  }
  return upper;
}

ResidualWhitener::ResidualWhitener(const ModelHealthSettings& settings) noexcept {
  const double interval = settings.interval_s;
  const double memory = settings.correlation_time_s;
  slow_variance_ = settings.model_error_mm * settings.model_error_mm;
  keep_ = std::exp(-interval / memory);
  // Computes mean and variance of an Ornstein-Uhlenbeck process, and of its average over one interval. The
  // state at the start of the interval is known.
  observe_ = memory / interval * (1 - keep_);
  process_variance_ = slow_variance_ * (1 - keep_ * keep_);
  average_variance_ = slow_variance_ * memory / (interval * interval) *
                      (2 * interval - memory * (3 - 4 * keep_ + keep_ * keep_));
  shared_covariance_ = slow_variance_ * memory / interval * (1 - keep_) * (1 - keep_);
  noise_variance_ = settings.noise_mm * settings.noise_mm;
  variance_ = slow_variance_;
}

void ResidualWhitener::reset() noexcept {
  estimate_mm_ = 0;
  variance_ = slow_variance_;
}

double ResidualWhitener::next(double average_mm, double count) noexcept {
  const double innovation = average_mm - observe_ * estimate_mm_;
  const double expected = observe_ * observe_ * variance_ + average_variance_ + noise_variance_ / count;
  const double gain = (keep_ * observe_ * variance_ + shared_covariance_) / expected;
  estimate_mm_ = keep_ * estimate_mm_ + gain * innovation;
  variance_ = keep_ * keep_ * variance_ + process_variance_ - gain * gain * expected;
  return innovation / std::sqrt(expected);
}

ModelHealth::ModelHealth(const ModelHealthSettings& settings, double tick_s) noexcept
    : settings_(settings), whitener_(settings) {
  threshold_ = cusum_threshold(settings.allowance_sigma,
                               std::max(2.0, settings.false_alarm_interval_s / settings.interval_s));
  forget_ = lag_share(settings.interval_s, settings.unfit_window_s);
  ticks_per_interval_ = static_cast<std::uint32_t>(std::max(1.0, std::round(settings.interval_s / tick_s)));
}

void ModelHealth::reset() noexcept {
  whitener_.reset();
  ticks_ = observed_ = 0;
  sum_mm_ = up_ = down_ = mean_square_mm2_ = 0;
  alarmed_ = false;
  state_ = HealthState::unknown;
}

bool ModelHealth::observe(double residual_mm) noexcept {
  sum_mm_ += residual_mm;
  ++observed_;
  return end_tick();
}

bool ModelHealth::skip() noexcept {
  return end_tick();
}

bool ModelHealth::end_tick() noexcept {
  if (++ticks_ < ticks_per_interval_) return false;
  // An interval is evaluated only if at least half of its ticks have a reading.
  const bool enough = 2 * observed_ >= ticks_per_interval_;
  const bool changed = enough && judge_interval();
  if (!enough) whitener_.reset();
  ticks_ = observed_ = 0;
  sum_mm_ = 0;
  return changed;
}

bool ModelHealth::judge_interval() noexcept {
  const double average_mm = sum_mm_ / observed_;
  const double innovation = whitener_.next(average_mm, observed_);
  const double cap = cap_share * threshold_;
  up_ = std::clamp(up_ + innovation - settings_.allowance_sigma, 0.0, cap);
  down_ = std::clamp(down_ - innovation - settings_.allowance_sigma, 0.0, cap);
  alarmed_ = std::max(up_, down_) >= threshold_ || (alarmed_ && std::max(up_, down_) > 0);
  const double square = average_mm * average_mm;
  mean_square_mm2_ =
      state_ == HealthState::unknown ? square : mean_square_mm2_ + forget_ * (square - mean_square_mm2_);

  const double bound_mm = settings_.unfit_mm * (state_ == HealthState::unfit ? recovery_share : 1);
  const HealthState before = state_;
  if (rms_mm() > bound_mm) {
    state_ = HealthState::unfit;
  } else {
    state_ = alarmed_ ? HealthState::suspect : HealthState::healthy;
  }
  return state_ != before;
}

double ModelHealth::rms_mm() const noexcept {
  return std::sqrt(mean_square_mm2_);
}

}  // namespace softgrip::control
