#include "control/elements/jump_watch.h"

#include <algorithm>
#include <cmath>

#include "base/time.h"

namespace softgrip::control {
namespace {

/// Largest ratio of the motion of a free finger to the motion of its model. The part of a motion beyond this
/// ratio counts as unexplained.
constexpr double more_than_model = 1.5;

/// Returns the part of a motion that the model does not explain [mm]. The sign of the result gives the
/// direction of this part.
double unexplained_mm(double moved_mm, double model_mm) noexcept {
  const double least = std::min(0.0, more_than_model * model_mm);
  const double most = std::max(0.0, more_than_model * model_mm);
  return moved_mm - std::clamp(moved_mm, least, most);
}

}  // namespace

JumpWatch::JumpWatch(const PlausibilitySettings& settings) noexcept
    : jump_mm_(settings.jump_mm),
      unsteady_jumps_(
          std::clamp(settings.unsteady_jumps, 2U, static_cast<std::uint32_t>(most_unsteady_jumps))),
      longest_gap_(nanoseconds(settings.max_age_s)) {}

void JumpWatch::reset() noexcept {
  known_ = unsteady_ = false;
  last_jump_mm_ = 0;
  turn_count_ = 0;
}

void JumpWatch::observe(Nanoseconds sampled_at, double reading_mm, double expected_mm) noexcept {
  const bool follows = known_ && sampled_at - last_at_ <= longest_gap_;
  const double jump_mm = follows ? unexplained_mm(reading_mm - last_mm_, expected_mm - last_expected_mm_) : 0;
  known_ = true;
  last_at_ = sampled_at;
  last_mm_ = reading_mm;
  last_expected_mm_ = expected_mm;
  if (std::abs(jump_mm) > jump_mm_) {
    const bool back = jump_mm * last_jump_mm_ < 0;
    last_jump_mm_ = jump_mm;
    last_jump_at_ = sampled_at;
    if (back) turn_back(sampled_at);
  } else if (unsteady_ && sampled_at - last_jump_at_ >= nanoseconds(calm_s)) {
    unsteady_ = false;
    turn_count_ = 0;
  }
}

void JumpWatch::turn_back(Nanoseconds now) noexcept {
  turns_[turn_at_] = now;
  turn_at_ = (turn_at_ + 1) % turns_.size();
  turn_count_ = std::min(turn_count_ + 1, static_cast<std::uint32_t>(turns_.size()));
  if (turn_count_ < unsteady_jumps_) return;
  const Nanoseconds first = turns_[(turn_at_ + turns_.size() - unsteady_jumps_) % turns_.size()];
  if (now - first <= nanoseconds(window_s)) unsteady_ = true;
}

}  // namespace softgrip::control
