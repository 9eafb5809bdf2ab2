#pragma once
// Pressure that stays on although nothing moves: after a stop or a fault that holds, or behind a sequence.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/settings.h"
#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// Returns null if no finger stays under pressure. Otherwise it returns `channels` (a list of `name` and
/// `command_kpa`), `command` (vents them) and `text` (both in one or two sentences).
[[nodiscard]] nlohmann::ordered_json under_pressure_json(
    const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot);

}  // namespace softgrip::daemon
