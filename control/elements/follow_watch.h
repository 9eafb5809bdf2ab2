#pragma once
// Decides if a finger that moves less than its model is held by an object, or has changed.

#include <cmath>

namespace softgrip::control {

/// Detects if a finger is held by an object. A held finger stays where it made contact while the model
/// continues. A finger whose gain has changed continues with its model, but less far. Until the model has
/// moved far enough to decide, a finger counts as held.
class FollowWatch {
 public:
  static constexpr double tells_from_mm = 1;  ///< the model's motion needed for a decision
  static constexpr double least_share = 0.5;  ///< of that motion, if nothing holds the finger

  void reset() noexcept { touching_ = held_ = false; }

  /// Processes one tick. `touching`: the finger lags the model by more than the margin of grip detection. The
  /// other arguments are the reading and the model position [mm]. Non-finite values change nothing.
  void observe(bool touching, double displacement_mm, double expected_mm) noexcept {
    if (!touching) return reset();
    if (!std::isfinite(displacement_mm) || !std::isfinite(expected_mm)) return;
    if (!touching_) {
      touching_ = held_ = true;
      from_mm_ = displacement_mm;
      expected_from_mm_ = expected_mm;
    }
    const double expected = expected_mm - expected_from_mm_;
    if (std::abs(expected) < tells_from_mm) return;
    held_ = (displacement_mm - from_mm_) / expected < least_share;
  }

  [[nodiscard]] bool held() const noexcept { return held_; }

 private:
  bool touching_ = false;
  bool held_ = false;
  double from_mm_ = 0;
  double expected_from_mm_ = 0;
};

}  // namespace softgrip::control
