#include "control/feedforward/jump_detector.h"

#include <algorithm>
#include <cmath>

namespace softgrip::control {
namespace {

constexpr double least_jump_mm = 0.5;
constexpr double least_share_of_span = 0.01;
/// Longest tick for which the threshold does not increase with the tick.
constexpr double usual_tick_s = 0.005;
constexpr double times_usual = 6;
/// Share of a new difference in the mean of the differences. The mean covers about 20 ticks.
constexpr double mean_share = 0.05;
/// A difference counts in the mean at most as this multiple of the threshold. With this limit, a single jump
/// of any size does not increase the threshold.
constexpr double counted_thresholds = 3;

}  // namespace

JumpDetector::JumpDetector(double tick_s, double span_mm) noexcept
    : least_mm_(std::max(least_jump_mm, least_share_of_span * span_mm) *
                std::max(1.0, tick_s / usual_tick_s)) {}

void JumpDetector::start(double target_mm) noexcept {
  usual_mm_ = 0;
  last_mm_ = target_mm;
  last_increment_mm_ = 0;
}

bool JumpDetector::jumps_to(double target_mm) noexcept {
  if (!std::isfinite(target_mm)) return false;
  const double increment_mm = target_mm - last_mm_;
  const double difference_mm = std::abs(increment_mm - last_increment_mm_);
  const double threshold_mm = std::max(least_mm_, times_usual * usual_mm_);
  const bool jump = difference_mm > threshold_mm;
  usual_mm_ += mean_share * (std::min(difference_mm, counted_thresholds * threshold_mm) - usual_mm_);
  last_mm_ = target_mm;
  last_increment_mm_ = jump ? 0 : increment_mm;
  return jump;
}

}  // namespace softgrip::control
