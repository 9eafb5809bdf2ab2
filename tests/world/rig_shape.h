#pragma once
// The rigs of the worlds: the example rig with other rates, patience, slew and watchdogs.

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

  /// After a settle time, the next look of the bus at the clock is behind its last commands. If it pauses
  /// there, it writes them late, which is not promised.
  [[nodiscard]] bool may_pause_late() const noexcept {
    return (trip_latches || watchdog == 0) && habits.settle == 0;
  }
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);
/// One seed in five has a board with habits, or each (`always`).
void draw_habits(RigShape& shape, bool always);

}  // namespace softgrip::world
