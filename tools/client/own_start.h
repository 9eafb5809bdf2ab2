#pragma once
// Starts that the program which made them may have to take back: the daemon stops one by its `start_id`
// (docs/reference/socket-api.md, "A stop of one start").

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// Returns an id that no other start has.
[[nodiscard]] std::string new_start_id();

/// Asks the daemon. Returns nullopt if it can stop one start alone; else the reason to make no start.
[[nodiscard]] std::optional<ClientFailure> cannot_name_starts(DaemonClient& client);

/// Returns the request that stops the start with this id and nothing else.
[[nodiscard]] nlohmann::ordered_json stop_of(const std::string& start_id);

/// Returns true if, by the daemon's reply to stop_of(), the start does not run and will not begin.
[[nodiscard]] bool confirms_stop(const nlohmann::ordered_json& reply);

/// Returns true if the daemon refused a start with this reply, so that it does not run. A loop that did not
/// answer in time may still begin it: false.
[[nodiscard]] bool refuses_start(const nlohmann::ordered_json& reply);

}  // namespace softgrip::tools
