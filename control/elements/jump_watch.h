#pragma once
// Detects a sensor that jumps back and forth. plausibility.h rejects single jumps, but a single jump may be
// too short to become a fault. A sensor that jumps repeatedly is not reliable enough for grip detection.

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/elements/plausibility.h"

namespace softgrip::control {

/// Counts jumps that are opposite to the previous jump. A jump is the change between two readings that
/// exceeds the change of the model. A free finger moves at most slightly more than its model. A part that
/// slides, is lost or is pushed in also makes the finger jump, but in one direction only.
class JumpWatch {
 public:
  static constexpr double window_s = 1;  ///< time in which the jumps are counted
  static constexpr double calm_s = 2;    ///< time without a jump after which the sensor counts as steady

  explicit JumpWatch(const PlausibilitySettings& settings) noexcept;

  /// Forgets everything.
  void reset() noexcept;
  /// Processes a new reading that is electrically valid, and the model's displacement at the same time [mm].
  void observe(Nanoseconds sampled_at, double reading_mm, double expected_mm) noexcept;

  /// Returns true after `unsteady_jumps` reversing jumps within a window, until the sensor is steady again.
  [[nodiscard]] bool unsteady() const noexcept { return unsteady_; }
  /// Returns the last jump [mm]; the sign is the direction.
  [[nodiscard]] double last_jump_mm() const noexcept { return last_jump_mm_; }

 private:
  void turn_back(Nanoseconds now) noexcept;

  double jump_mm_;
  std::uint32_t unsteady_jumps_;
  Nanoseconds longest_gap_;
  bool known_ = false;  ///< there is an earlier reading to which a new one is compared
  Nanoseconds last_at_ = 0;
  double last_mm_ = 0;
  double last_expected_mm_ = 0;
  double last_jump_mm_ = 0;
  Nanoseconds last_jump_at_ = 0;
  std::array<Nanoseconds, most_unsteady_jumps> turns_{};  ///< ring of the times of the last reversing jumps
  std::size_t turn_at_ = 0;
  std::uint32_t turn_count_ = 0;
  bool unsteady_ = false;
};

}  // namespace softgrip::control
