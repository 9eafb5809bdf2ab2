#pragma once
// Gives a start its own `start_id`. With this id, a program can stop its own start without stopping any other
// (docs/reference/socket-api.md, "A stop of one start").

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// Returns a unique id for a start.
[[nodiscard]] std::string new_start_id();

/// Checks that the daemon can stop a single start by its id. Returns nullopt if it can, else the reason for
/// not requesting a start.
[[nodiscard]] std::optional<ClientFailure> cannot_name_starts(DaemonClient& client);

/// Returns the request that stops only the start with this id.
[[nodiscard]] nlohmann::ordered_json stop_of(const std::string& start_id);

/// Returns true if the daemon's reply to stop_of() confirms that the start does not run and will not begin.
[[nodiscard]] bool confirms_stop(const nlohmann::ordered_json& reply);

/// Returns true if this reply means that the daemon refused the start. Returns false if the control loop did
/// not respond in time, because it may still begin the start.
[[nodiscard]] bool refuses_start(const nlohmann::ordered_json& reply);

}  // namespace softgrip::tools
