#include "control/elements/plausibility.h"

#include <algorithm>
#include <cmath>

#include "base/time.h"

namespace softgrip::control {
namespace {
double between_s(Nanoseconds from, Nanoseconds to) {
  return static_cast<double>(to - from) * 1e-9;
}
}  // namespace

Plausibility::Plausibility(const PlausibilitySettings& settings) noexcept
    : settings_(settings),
      max_age_(nanoseconds(settings.max_age_s)),
      frozen_after_(nanoseconds(settings.frozen_after_s)) {}

void Plausibility::reset() noexcept {
  known_ = false;
  watching_ = false;
}

bool Plausibility::jumped(const model::Reading& reading) const noexcept {
  if (!known_) return false;
  const double elapsed_s = std::max(0.0, between_s(last_sampled_at_, reading.sampled_at));
  return std::abs(reading.displacement_mm - last_mm_) >
         settings_.max_speed_mm_per_s * elapsed_s + settings_.jump_margin_mm;
}

bool Plausibility::frozen(const model::Reading& reading, double command_kpa) noexcept {
  if (!watching_ || std::abs(reading.displacement_mm - still_mm_) > settings_.frozen_band_mm) {
    watching_ = true;
    still_mm_ = reading.displacement_mm;
    still_since_ = reading.sampled_at;
    lowest_command_kpa_ = highest_command_kpa_ = command_kpa;
    return false;
  }
  lowest_command_kpa_ = std::min(lowest_command_kpa_, command_kpa);
  highest_command_kpa_ = std::max(highest_command_kpa_, command_kpa);
  return reading.sampled_at - still_since_ >= frozen_after_ &&
         highest_command_kpa_ - lowest_command_kpa_ >= settings_.frozen_command_kpa;
}

model::Validity Plausibility::judge(const model::Reading& reading, Nanoseconds now,
                                    double command_kpa) noexcept {
  using model::Validity;
  if (reading.validity != Validity::valid) return reading.validity;
  if (!std::isfinite(reading.displacement_mm)) return Validity::out_of_range;
  if (now - reading.sampled_at > max_age_) return Validity::stale;
  if (jumped(reading)) return Validity::jumped;
  if (frozen(reading, command_kpa)) return Validity::frozen;
  known_ = true;
  last_mm_ = reading.displacement_mm;
  last_sampled_at_ = reading.sampled_at;
  return Validity::valid;
}

}  // namespace softgrip::control
