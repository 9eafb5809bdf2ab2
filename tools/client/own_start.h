#pragma once
// Requests a start with a `start_id` of its own. With this id, a program can stop its own start and does not
// affect the start of another program (docs/reference/socket-api.md, "A stop of one start").

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// Returns a new id for a start that no other start has.
[[nodiscard]] std::string new_start_id();

/// Checks that the daemon supports `start_id`, so that a program can stop its own start alone. Returns
/// nullopt if the daemon supports it, otherwise the reason why the program must not request a start.
[[nodiscard]] std::optional<ClientFailure> check_start_id_support(DaemonClient& client);

/// Returns the request to stop the start with this id and no other start.
[[nodiscard]] nlohmann::ordered_json stop_request_for(const std::string& start_id);

/// Returns true if the daemon's reply to the request of stop_request_for() confirms that the start does not
/// run and will not begin.
[[nodiscard]] bool confirms_stop(const nlohmann::ordered_json& reply);

/// Returns true if this reply of the daemon refuses the start. Returns false if the reply states that the
/// control loop did not respond in time, because the loop may still begin this start.
[[nodiscard]] bool refuses_start(const nlohmann::ordered_json& reply);

}  // namespace softgrip::tools
