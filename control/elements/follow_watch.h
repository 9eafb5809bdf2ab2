#pragma once
// Decides why a finger moves less than its model. There are two possible reasons: an object holds the finger,
// or the finger has changed.

#include <cmath>

namespace softgrip::control {

/// Decides if an object holds a finger that lags its model. A held finger stays at its contact position while
/// its model continues to move. A finger whose gain has changed moves together with its model, but over a
/// shorter distance. Until the model has moved by tells_from_mm after the contact, the finger counts as held.
class FollowWatch {
 public:
  static constexpr double tells_from_mm = 1;  ///< distance that the model must move after contact before this
                                              ///< class decides if the finger is held
  static constexpr double least_share = 0.5;  ///< smallest ratio of finger motion to model motion at which
                                              ///< the finger counts as not held; if the ratio is smaller, an
                                              ///< object holds the finger

  void reset() noexcept { touching_ = held_ = false; }

  /// Processes one tick. `touching` is true if the finger lags its model by more than the margin of grip
  /// detection. `displacement_mm` is the reading, and `expected_mm` is the displacement of the model. A tick
  /// in which one of the two displacements is not finite is ignored.
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
