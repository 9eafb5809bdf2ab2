#pragma once
// A world in which `softgrip calibrate --move` or `softgrip doctor --move` drives the board without a daemon.
// A simulated operator reads gauges and sometimes presses Ctrl-C.

#include "tests/world/world.h"

namespace softgrip::world {

/// `options.tool` is Tool::calibrate or Tool::doctor.
[[nodiscard]] WorldResult run_motion_world(const Library& library, std::uint64_t seed,
                                           const WorldOptions& options);

}  // namespace softgrip::world
