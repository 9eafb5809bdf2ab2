#pragma once
// Detects a sensor whose reading jumps back and forth. plausibility.h rejects single jumps, but a jump that
// lasts only a few cycles does not become a fault. A sensor that jumps repeatedly is not reliable enough for
// grip detection.

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/elements/plausibility.h"

namespace softgrip::control {

/// Counts jumps whose direction is opposite to that of the previous jump. A jump is the part of a change
/// between two readings that the model does not explain. A held part that slides, is lost or is pushed in
/// also causes jumps, but in one direction only.
class JumpWatch {
 public:
  static constexpr double window_s = 1;  ///< time within which the reversing jumps are counted
  static constexpr double calm_s = 2;    ///< time without a jump after which the sensor counts as steady

  explicit JumpWatch(const PlausibilitySettings& settings) noexcept;

  /// Discards all readings and jumps.
  void reset() noexcept;
  /// Processes a new, electrically valid reading and the model's displacement at the time of the reading
  /// [mm].
  void observe(Nanoseconds sampled_at, double reading_mm, double expected_mm) noexcept;

  /// Returns true after `unsteady_jumps` reversing jumps within window_s. The result stays true until the
  /// sensor is steady for calm_s.
  [[nodiscard]] bool unsteady() const noexcept { return unsteady_; }
  /// Returns the size of the last jump [mm]; negative for a decrease of the reading.
  [[nodiscard]] double last_jump_mm() const noexcept { return last_jump_mm_; }

 private:
  void turn_back(Nanoseconds now) noexcept;

  double jump_mm_;
  std::uint32_t unsteady_jumps_;
  Nanoseconds longest_gap_;
  bool known_ = false;  ///< true: an earlier reading exists, with which the next reading is compared
  Nanoseconds last_at_ = 0;
  double last_mm_ = 0;
  double last_expected_mm_ = 0;
  double last_jump_mm_ = 0;
  Nanoseconds last_jump_at_ = 0;
  std::array<Nanoseconds, most_unsteady_jumps> turns_{};  ///< ring buffer with the times of the last
                                                          ///< reversing jumps
  std::size_t turn_at_ = 0;
  std::uint32_t turn_count_ = 0;
  bool unsteady_ = false;
};

}  // namespace softgrip::control
