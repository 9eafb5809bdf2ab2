#include "control/elements/plausibility.h"

#include <algorithm>
#include <cmath>

#include "base/time.h"

namespace softgrip::control {
namespace {
double between_s(Nanoseconds from, Nanoseconds to) {
  return static_cast<double>(to - from) * 1e-9;
}

/// Number of changes of the reading after which longest_run_ is used to judge the sensor.
constexpr std::uint32_t enough_changes = 50;
/// A time without a change of the reading is implausible if it exceeds both of two bounds. The first bound is
/// unlike_times multiplied by the longest earlier time without a change. The second bound is unlike_at_least.
constexpr Nanoseconds unlike_times = 4;
constexpr Nanoseconds unlike_at_least = ns_per_s / 10;

}  // namespace

Plausibility::Plausibility(const PlausibilitySettings& settings) noexcept
    : settings_(settings),
      max_age_(nanoseconds(settings.max_age_s)),
      frozen_after_(nanoseconds(settings.frozen_after_s)) {}

void Plausibility::reset() noexcept {
  known_ = false;
  watching_ = false;
  changes_ = 0;
  longest_run_ = 0;
  stands_still_ = false;
}

void Plausibility::Travel::see(double value) noexcept {
  lowest = std::min(lowest, value);
  highest = std::max(highest, value);
}

/// Stores the duration `run` of a constant reading that has just ended. Does not store a duration that was
/// implausible for this sensor.
void Plausibility::learn(Nanoseconds run) noexcept {
  if (stands_still_) return;
  longest_run_ = std::max(longest_run_, run);
  changes_ = std::min(changes_ + 1, enough_changes);
}

bool Plausibility::jumped(const model::Reading& reading) const noexcept {
  if (!known_) return false;
  const double elapsed_s = std::max(0.0, between_s(last_sampled_at_, reading.sampled_at));
  return std::abs(reading.displacement_mm - last_mm_) >
         settings_.max_speed_mm_per_s * elapsed_s + settings_.jump_margin_mm;
}

bool Plausibility::frozen(const model::Reading& reading, double command_kpa, double expected_mm) noexcept {
  if (!watching_ || std::abs(reading.displacement_mm - still_mm_) > settings_.frozen_band_mm) {
    if (watching_) learn(reading.sampled_at - still_since_);
    watching_ = true;
    still_mm_ = reading.displacement_mm;
    still_since_ = reading.sampled_at;
    command_kpa_ = {};
    expected_mm_ = {};
    stands_still_ = false;
  }
  command_kpa_.see(command_kpa);
  expected_mm_.see(expected_mm);
  const Nanoseconds run = reading.sampled_at - still_since_;
  stands_still_ = changes_ == enough_changes && run > std::max(unlike_at_least, unlike_times * longest_run_);
  if (run < frozen_after_) return false;
  return command_kpa_.length() >= settings_.frozen_command_kpa ||
         (stands_still_ && expected_mm_.length() >= settings_.frozen_expected_mm);
}

model::Validity Plausibility::judge(const model::Reading& reading, Nanoseconds now, double command_kpa,
                                    double expected_mm) noexcept {
  using model::Validity;
  if (reading.validity != Validity::valid) return reading.validity;
  if (!std::isfinite(reading.displacement_mm)) return Validity::out_of_range;
  if (now - reading.sampled_at > max_age_) return Validity::stale;
  if (jumped(reading)) return Validity::jumped;
  if (frozen(reading, command_kpa, expected_mm)) return Validity::frozen;
  known_ = true;
  last_mm_ = reading.displacement_mm;
  last_sampled_at_ = reading.sampled_at;
  return Validity::valid;
}

}  // namespace softgrip::control
