#pragma once
// Decides why a finger moves less than its model. There are two possible reasons: an object holds the finger,
// or the finger has changed.

#include <cmath>

namespace softgrip::control {

/// Detects that an object holds a finger. A held finger stays at its contact position while its model
/// continues to move. A finger whose gain has changed moves together with its model, but over a shorter
/// distance. Until the model has moved by tells_from_mm after the contact, the finger counts as held.
class FollowWatch {
 public:
  static constexpr double tells_from_mm = 1;  ///< motion of the model after contact that is needed for a
                                              ///< decision
  static constexpr double least_share = 0.5;  ///< if a finger moves by less than this share of its model's
                                              ///< motion, an object holds it

  void reset() noexcept { touching_ = held_ = false; }

  /// Processes one tick. `touching` is true if the finger lags its model by more than the margin of grip
  /// detection. `displacement_mm` is the reading, and `expected_mm` the position of the model. Values that
  /// are not finite are ignored.
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
