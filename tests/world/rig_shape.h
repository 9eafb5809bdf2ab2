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

  /// Returns true if the bus thread may be paused after it has read the clock. If the board has a settle
  /// time, the thread determines its commands before it reads the clock. A pause after this reading would
  /// delay the write of these commands, and the daemon could not prevent the late write.
  [[nodiscard]] bool may_pause_late() const noexcept {
    return (trip_latches || watchdog == 0) && habits.settle == 0;
  }
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);
/// Gives unusual properties to the boards of 1 seed in 5, or to all boards if `always` is true.
void draw_habits(RigShape& shape, bool always);

}  // namespace softgrip::world
