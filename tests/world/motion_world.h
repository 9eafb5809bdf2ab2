#pragma once
// Simulates a rig without a daemon. `softgrip calibrate --move` or `softgrip doctor --move` controls the
// board. A simulated operator reads gauges and sometimes presses Ctrl-C.

#include "tests/world/world.h"

namespace softgrip::world {

/// Runs one simulated world without a daemon. `options.tool` must be Tool::calibrate or Tool::doctor.
[[nodiscard]] WorldResult run_motion_world(const Library& library, std::uint64_t seed,
                                           const WorldOptions& options);

}  // namespace softgrip::world
