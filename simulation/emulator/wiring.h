#pragma once
// Default wiring of fingers to an emulated board, without a rig file.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::simulation {

/// Returns the wiring of channels left, right, finger_3, ... Valve i is on output i and sensor i on input i.
/// Pressure monitors are on the last inputs if there are enough inputs. Terminals are numbered across
/// modules. The lower end of the terminal range (0 V or 4 mA) is 0 kPa and -5 mm. The upper end (10 V or 20
/// mA) is 100 kPa and 45 mm, as in config/rig_tcp.yaml. Terminals in kilopascals represent valves and
/// pressure monitors directly. The error is one sentence.
[[nodiscard]] tl::expected<std::vector<drivers::ChannelWiring>, std::string> default_wiring(
    std::span<const drivers::BoardMap> modules, std::size_t channels);

}  // namespace softgrip::simulation
