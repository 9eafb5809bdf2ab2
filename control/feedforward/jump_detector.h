#pragma once
// Detects jumps of a sampled reference.

namespace softgrip::control {

/// Detects jumps of a reference that is sampled once per tick. A jump is a difference between two successive
/// increments of the reference that exceeds a threshold. The threshold is the larger of these values:
///
///   0.5 mm or 0.5 deg. At 200 Hz, a reversal from 50 mm/s upward to 50 mm/s downward has exactly this size.
///   6 times the mean absolute difference in the last ticks. The samples of a noisy reference, or of a
///   reference that changes much in every tick, therefore do not count as jumps after the first ticks.
///
/// After a jump, the reference is expected to stand still. If it jumps in the next tick too, this can be the
/// beginning of a fast motion or the second part of a jump that was interpolated. The reference may then
/// stand still or continue its last increment.
///
/// The first value does not depend on the tick or on the span of the finger. A jump that is not detected
/// causes a fast change of the command and an oscillation. A difference that is detected without need only
/// starts a short fade-out.
class JumpDetector {
 public:
  /// Starts with a reference that is constant at `target_mm`.
  void start(double target_mm) noexcept;
  /// Returns true if the reference jumps to `target_mm` in this tick. `target_mm` must be finite.
  [[nodiscard]] bool jumps_to(double target_mm) noexcept;

 private:
  double usual_mm_ = 0;           ///< mean absolute difference of the last ticks
  double last_mm_ = 0;            ///< reference of the last tick
  double last_increment_mm_ = 0;  ///< increment of the reference in the last tick; 0 after a single jump
  bool jumped_ = false;           ///< true: the reference jumped in the last tick
};

}  // namespace softgrip::control
