#pragma once
// Creates the rigs of the simulated worlds. They are variants of the example rig with other rates, fault
// delays, slew limits and watchdogs.

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

  /// Returns true if the world may pause the bus thread after the thread has read the clock. If the board has
  /// a settle time, the thread reads the clock after it has fixed its commands. A pause after this reading
  /// delays the write of these commands, which the daemon cannot prevent.
  [[nodiscard]] bool may_pause_late() const noexcept {
    return (trip_latches || watchdog == 0) && habits.settle == 0;
  }
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);
/// Gives the board peculiarities for 1 seed in 5, or for every seed if `always` is true.
void draw_habits(RigShape& shape, bool always);

}  // namespace softgrip::world
