#pragma once
// The rigs of the simulated worlds, which are variants of the example rig with other rates, fault delays,
// slew limits and watchdogs.

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

  /// Returns true if the bus thread may be paused after it has read the clock. If the board has a settle
  /// time, the thread reads the clock again only after it has fixed its commands. A pause after this reading
  /// makes the thread write the commands late, which the project does not prevent.
  [[nodiscard]] bool may_pause_late() const noexcept {
    return (trip_latches || watchdog == 0) && habits.settle == 0;
  }
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);
/// Gives the board of 1 seed in 5, or of every seed if `always` is true, some peculiarities.
void draw_habits(RigShape& shape, bool always);

}  // namespace softgrip::world
