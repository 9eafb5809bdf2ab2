#include "control/feedforward/jump_detector.h"

#include <algorithm>
#include <cmath>

namespace softgrip::control {
namespace {

constexpr double least_jump_mm = 0.5;
/// The differences of a reference with white noise are normally distributed. One of them exceeds 6 times
/// their mean absolute value, which is 4.8 standard deviations, with a probability of 2e-6.
constexpr double times_usual = 6;
/// Share of a new difference in the mean of the differences. The mean covers about 20 ticks.
constexpr double mean_share = 0.05;
/// A difference counts in the mean at most as this multiple of the threshold. With this limit, a single jump
/// of any size does not increase the threshold.
constexpr double counted_thresholds = 3;

}  // namespace

void JumpDetector::start(double target_mm) noexcept {
  usual_mm_ = 0;
  last_mm_ = target_mm;
  last_increment_mm_ = 0;
  jumped_ = false;
}

bool JumpDetector::jumps_to(double target_mm) noexcept {
  const double increment_mm = target_mm - last_mm_;
  double difference_mm = std::abs(increment_mm - last_increment_mm_);
  if (jumped_) difference_mm = std::min(difference_mm, std::abs(increment_mm));
  const double threshold_mm = std::max(least_jump_mm, times_usual * usual_mm_);
  const bool jump = difference_mm > threshold_mm;
  usual_mm_ += mean_share * (std::min(difference_mm, counted_thresholds * threshold_mm) - usual_mm_);
  last_mm_ = target_mm;
  // The increment of a single jump does not continue.
  last_increment_mm_ = jump && !jumped_ ? 0 : increment_mm;
  jumped_ = jump;
  return jump;
}

}  // namespace softgrip::control
