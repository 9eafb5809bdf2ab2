#pragma once
// How fingers are wired to an emulated board when no rig file says it.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::simulation {

/// Channels left, right, finger_3, ...: valve i on output i, sensor i on input i and, where there are inputs
/// enough, pressure monitors on the last inputs; terminals count on from module to module. The lower end of
/// the terminals' span (0 V or 4 mA) is 0 kPa and -5 mm, the upper (10 V or 20 mA) 100 kPa and 45 mm: as
/// config/rig_tcp.yaml has it. Terminals in kilopascals are valves and pressure monitors themselves.
/// The error is one sentence.
[[nodiscard]] tl::expected<std::vector<drivers::ChannelWiring>, std::string> default_wiring(
    std::span<const drivers::BoardMap> modules, std::size_t channels);

}  // namespace softgrip::simulation
