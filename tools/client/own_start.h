#pragma once
// Requests a start with a `start_id` of its own. With this id, a program can stop its own start without
// stopping the start of another program (docs/reference/socket-api.md, "A stop of one start").

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// Returns a new id for a start that no other start has.
[[nodiscard]] std::string new_start_id();

/// Checks that the daemon supports `start_id`, so that a single start can be stopped. Returns nullopt if it
/// does, else the reason for not requesting a start.
[[nodiscard]] std::optional<ClientFailure> cannot_name_starts(DaemonClient& client);

/// Returns the request that stops only the start with this id.
[[nodiscard]] nlohmann::ordered_json stop_of(const std::string& start_id);

/// Returns true if the daemon's reply to stop_of() confirms that the start is not running and will not begin.
[[nodiscard]] bool confirms_stop(const nlohmann::ordered_json& reply);

/// Returns true if the daemon has refused the start with this reply. Returns false if the reply states that
/// the control loop did not respond in time, because the loop may still begin the start.
[[nodiscard]] bool refuses_start(const nlohmann::ordered_json& reply);

}  // namespace softgrip::tools
