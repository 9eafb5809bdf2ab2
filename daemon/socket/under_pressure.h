#pragma once
// Reports fingers that are pressurised but do not move. This happens after a stop or a fault that holds, and
// after a sequence.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/settings.h"
#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// Returns null if no finger is pressurised. Otherwise returns an object with `channels` (a list of `name`
/// and `command_kpa`), `command` (the shell command that vents these channels) and `text` (one or two
/// sentences with both).
[[nodiscard]] nlohmann::ordered_json under_pressure_json(
    const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot);

}  // namespace softgrip::daemon
