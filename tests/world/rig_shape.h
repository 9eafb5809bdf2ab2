#pragma once
// The rigs of the worlds: the example rig with other rates, fault delays, slew limits and watchdogs.

#include <cstdint>
#include <string>

#include "rig/rig_file.h"
#include "tests/world/hardware.h"

namespace softgrip::world {

struct RigShape {
  rig::RigFile rig;
  std::uint64_t seed = 0;
  Nanoseconds watchdog = 0;
  bool trip_latches = true;
  Habits habits;
  std::string text;

  /// Returns true if the bus thread may be paused after it has read the clock. With a settle time, it reads
  /// the clock again only after its commands are fixed. A pause there writes them late, which the project
  /// does not rule out.
  [[nodiscard]] bool may_pause_late() const noexcept {
    return (trip_latches || watchdog == 0) && habits.settle == 0;
  }
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);
/// Gives one seed in 5 a board with habits, or every seed (`always`).
void draw_habits(RigShape& shape, bool always);

}  // namespace softgrip::world
