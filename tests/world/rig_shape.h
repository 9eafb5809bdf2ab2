#pragma once
// Creates the rigs of the simulated worlds. The rigs are variants of the example rig with different rates,
// fault delays, slew limits and watchdogs.

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

  /// Returns true if the tests may pause the bus thread between its reading of the clock and its write. They
  /// do not pause it in two cases, in which the daemon cannot prevent a late write: any write clears a
  /// watchdog trip of the board, or the board has a settle time. With a settle time, the thread determines
  /// its commands before it reads the clock.
  [[nodiscard]] bool may_pause_late() const noexcept {
    return (trip_latches || watchdog == 0) && habits.settle == 0;
  }
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);
/// Gives unusual properties to the boards of 1 seed in 5, or to all boards if `always` is true.
void draw_habits(RigShape& shape, bool always);

}  // namespace softgrip::world
