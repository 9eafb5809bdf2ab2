#pragma once
// Pressure that stays on although nothing moves: after a stop or a fault that holds, or behind a sequence.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/settings.h"
#include "daemon/loop/wires.h"

namespace softgrip::daemon {

/// Null where no finger stays under pressure; else `channels`, a list of `name` and
/// `command_kpa`; `command`, which ends it; and `text`, which says both in a sentence or two.
[[nodiscard]] nlohmann::ordered_json under_pressure_json(
    const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot);

}  // namespace softgrip::daemon
