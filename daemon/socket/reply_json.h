#pragma once
// Builds the parts of replies of the socket API that do not depend on the state: errors, problems, sequences,
// greeting.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/recording/sequence_store.h"
#include "daemon/socket/client_request.h"
#include "daemon/socket/sequence_loader.h"
#include "document/problem.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// Returns the id of a request as JSON; null if the client gave no id.
[[nodiscard]] nlohmann::ordered_json id_json(std::optional<std::uint64_t> id);
[[nodiscard]] nlohmann::ordered_json error_json(std::string_view code, std::string_view message);
[[nodiscard]] nlohmann::ordered_json problems_json(const std::vector<document::Problem>& problems);
[[nodiscard]] nlohmann::ordered_json sequences_json(
    const std::vector<SequenceLoader::SequenceInfo>& sequences);
/// Describes a sequence for the reply to a start with dry_run.
[[nodiscard]] nlohmann::ordered_json checked_json(const LoadedSequence& sequence);

/// The data of the reply to the request `hello`.
struct HelloData {
  std::string_view software_version;
  std::string_view started_at;  ///< start time of the daemon, UTC; an event id is unique in combination with
                                ///< this time
  Role role = Role::look;
  std::string_view client;  ///< name of the client, as the client gave it
  double reply_timeout_s = 0;
};
[[nodiscard]] nlohmann::ordered_json hello_json(const HelloData& hello, const rig::SocketSettings& settings);

/// Returns the error reply for two cases: a client that is refused before its first request, and a line that
/// cannot be parsed.
[[nodiscard]] std::string error_line(std::optional<std::uint64_t> id, std::string_view code,
                                     std::string_view message);

}  // namespace softgrip::daemon
