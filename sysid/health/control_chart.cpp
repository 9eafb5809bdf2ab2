#include "sysid/health/control_chart.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/elements/model_health.h"

namespace softgrip::sysid::health {
namespace {

/// Limit that decides where a change begins if a single value raises the alarm, as a share of
/// `pause_learning`. If the CUSUM before this value exceeded the limit, the change begins where the CUSUM
/// begins. Otherwise the change begins at the single value.
constexpr double on_its_way_share = 0.6;

/// Returns the limit that the magnitude of a standard normal value exceeds on average once in `once_in`
/// values.
double two_sided_limit(double once_in) {
  double lower = 0, upper = 40;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (lower + upper);
    (std::erfc(middle / std::numbers::sqrt2) * once_in > 1 ? lower : upper) = middle;
  }
  return upper;
}

}  // namespace

ChartLimits ChartLimits::for_run_length(double run_length) {
  ChartLimits limits;
  limits.cusum = control::cusum_threshold(limits.allowance, 2 * run_length);
  limits.single = two_sided_limit(2 * run_length);
  return limits;
}

std::optional<double> ControlChart::excess_of(const ChartValues& values) const {
  double sum = 0, count = 0;
  for (const auto& [recipe, value] : values) {
    const auto reference = references_.find(recipe);
    if (reference == references_.end() || reference->second.count() < 2) continue;
    sum += value.value - reference->second.expected(value.temperature_c);
    count += 1;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::optional<double> ControlChart::add(const ChartValues& values) {
  double sum = 0, count = 0, compared = 0, persistence = 0;
  for (const auto& [recipe, value] : values) {
    const auto reference = references_.find(recipe);
    if (reference == references_.end()) continue;
    if (const auto z = reference->second.judge(value.value, least_spread_, value.temperature_c)) {
      sum += *z;
      count += 1;
      compared += static_cast<double>(reference->second.count());
      persistence += reference->second.persistence();
    }
  }
  std::optional<double> z;
  if (count > 0) z = sum / count;
  history_.push_back(values);
  if (z) {
    ++judged_;
    if (!alarm_) judge(*z, compared / count, persistence / count);
  }
  if (!alarm_) {
    waiting_.push_back(values);
    if (std::max(up_, down_) <= limits_.pause_learning) {
      for (const ChartValues& learnt : waiting_) learn(learnt);
      waiting_.clear();
    }
    return z;
  }
  measure_change();
  return z;
}

void ControlChart::take_alarm(std::size_t since) {
  if (since == 0 || since >= history_.size() || (alarm_ && alarm_->since <= since)) return;
  alarm_ = ChartAlarm{alarm_ ? alarm_->noticed : history_.size() - 1, since, 0};
  forget_since(since);
  measure_change();
}

void ControlChart::measure_change() {
  double excesses = 0, known = 0;
  for (std::size_t i = alarm_->since; i < history_.size(); ++i) {
    const auto excess = excess_of(history_[i]);
    excesses += excess.value_or(0);
    known += excess ? 1 : 0;
  }
  alarm_->change = known > 0 ? excesses / known : 0;
}

void ControlChart::learn(const ChartValues& values) {
  for (const auto& [recipe, value] : values) references_[recipe].learn(value.value, value.temperature_c);
}

void ControlChart::forget_since(std::size_t point) {
  references_.clear();
  for (std::size_t i = 0; i < point; ++i) learn(history_[i]);
}

void ControlChart::judge(double z, double count, double persistence) {
  const std::size_t now = history_.size() - 1;
  if (up_ == 0) up_since_ = now;
  if (down_ == 0) down_since_ = now;
  const bool learning_paused = std::max(up_, down_) > limits_.pause_learning;
  const double allowance = limits_.allowance + (learning_paused ? 1 / std::sqrt(count) : 0);
  const double slow = z * std::sqrt((1 - persistence) / (1 + persistence));
  const bool on_its_way = (z > 0 ? up_ : down_) > on_its_way_share * limits_.pause_learning;
  up_ = std::max(0.0, up_ + slow - allowance);
  down_ = std::max(0.0, down_ - slow - allowance);
  std::optional<std::size_t> since;
  if (std::max(up_, down_) > limits_.cusum) {
    since = up_ > down_ ? up_since_ : down_since_;
  } else if (std::abs(z) > limits_.single) {
    since = !on_its_way ? now : z > 0 ? up_since_ : down_since_;
  }
  if (!since) return;
  alarm_ = ChartAlarm{now, *since, 0};
  forget_since(*since);
}

}  // namespace softgrip::sysid::health
