#pragma once
// Detects jumps of a sampled reference.

namespace softgrip::control {

/// Detects jumps of a reference that is sampled once per tick. A jump is a difference between two successive
/// increments of the reference that exceeds a threshold. The threshold is the largest of these values:
///
///   0.5 mm or 0.5 deg. At 200 Hz, a reversal from 50 mm/s upward to 50 mm/s downward has exactly this size.
///   1 % of the span of the finger.
///   6 times the mean absolute difference in the last ticks. The samples of a noisy reference, or of a
///   reference that changes much in every tick, therefore do not count as jumps.
///
/// For ticks longer than 5 ms, the first two values increase in proportion to the tick. The threshold then
/// corresponds to the same change of speed.
class JumpDetector {
 public:
  /// @param tick_s  duration of a tick [s], > 0.
  /// @param span_mm  difference of the displacements at the two ends of the pressure range [mm], >= 0.
  JumpDetector(double tick_s, double span_mm) noexcept;

  /// Starts with a reference that is constant at `target_mm`.
  void start(double target_mm) noexcept;
  /// Returns true if the reference jumps to `target_mm` in this tick. A value that is not finite is ignored.
  [[nodiscard]] bool jumps_to(double target_mm) noexcept;

 private:
  double least_mm_;               ///< smallest difference that counts as a jump
  double usual_mm_ = 0;           ///< mean absolute difference of the last ticks
  double last_mm_ = 0;            ///< reference of the last tick
  double last_increment_mm_ = 0;  ///< increment of the reference in the last tick; 0 after a jump
};

}  // namespace softgrip::control
