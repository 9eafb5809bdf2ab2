#pragma once
// Reports fingers that are pressurised without motion: after a stop or a fault that holds, or after a
// sequence.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/settings.h"
#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// Returns null if no finger is pressurised. Otherwise returns `channels` (a list of `name` and
/// `command_kpa`), `command` (the command line that vents them) and `text` (one or two sentences with both).
[[nodiscard]] nlohmann::ordered_json under_pressure_json(
    const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot);

}  // namespace softgrip::daemon
