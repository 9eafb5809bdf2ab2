#pragma once
// Does a sensor jump there and back? Single jumps are judged by plausibility.h and may be too short to be a
// fault there; a sensor that keeps jumping is no sensor to grip by.

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/elements/plausibility.h"

namespace softgrip::control {

/// Counts jumps that reverse. A jump is the change between two readings beyond the change of the model. A
/// finger moves between nothing and slightly more than its free-motion model. A part that slides, is lost or
/// is pushed in also makes the finger jump, but in one direction only.
class JumpWatch {
 public:
  static constexpr double window_s = 1;  ///< in which the jumps are counted
  static constexpr double calm_s = 2;    ///< without a jump: steady again

  explicit JumpWatch(const PlausibilitySettings& settings) noexcept;

  /// Forgets everything.
  void reset() noexcept;
  /// A new reading that is electrically sound, and what the model says of that time [mm].
  void observe(Nanoseconds sampled_at, double reading_mm, double expected_mm) noexcept;

  /// It has jumped there and back `unsteady_jumps` times within a window, and was not calm since.
  [[nodiscard]] bool unsteady() const noexcept { return unsteady_; }
  /// How far it jumped last [mm]; the sign is the direction.
  [[nodiscard]] double last_jump_mm() const noexcept { return last_jump_mm_; }

 private:
  void turn_back(Nanoseconds now) noexcept;

  double jump_mm_;
  std::uint32_t unsteady_jumps_;
  Nanoseconds longest_gap_;
  bool known_ = false;  ///< there is a reading to jump from
  Nanoseconds last_at_ = 0;
  double last_mm_ = 0;
  double last_expected_mm_ = 0;
  double last_jump_mm_ = 0;
  Nanoseconds last_jump_at_ = 0;
  std::array<Nanoseconds, most_unsteady_jumps> turns_{};  ///< ring of the last jumps that turned back
  std::size_t turn_at_ = 0;
  std::uint32_t turn_count_ = 0;
  bool unsteady_ = false;
};

}  // namespace softgrip::control
