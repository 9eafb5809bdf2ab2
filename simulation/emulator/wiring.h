#pragma once
// Provides a default wiring of fingers to an emulated board, for an emulator that is started without a rig
// file.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::simulation {

/// Returns the wiring of the channels left, right, finger_3, ... Valve i is on output i, and sensor i is on
/// input i. If the board has at least two inputs per finger, the last inputs are pressure monitors. The
/// terminals of all modules are numbered consecutively. The lower end of a terminal's range (0 V or 4 mA) is
/// 0 kPa and -5 mm. The upper end (10 V or 20 mA) is 100 kPa and 45 mm, as in config/rig_tcp.yaml. A terminal
/// with the unit kPa is a pressure generator or a pressure sensor, so it needs no scaling. The error is one
/// sentence.
[[nodiscard]] tl::expected<std::vector<drivers::ChannelWiring>, std::string> default_wiring(
    std::span<const drivers::BoardMap> modules, std::size_t channels);

}  // namespace softgrip::simulation
