#pragma once
// Reads one line of a client of the socket API into a plain value. Lines come from outside, so this parser is
// fuzzed (tests/daemon/socket/client_request_fuzz.cpp). docs/reference/socket-api.md describes the requests.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "control/tick/parameter.h"
#include "daemon/socket/role.h"

namespace softgrip::daemon {

/// Version of the socket API.
inline constexpr std::uint64_t api_version = 1;

struct ClientRequest {
  enum class Command : std::uint8_t {
    status,
    watch,
    unwatch,
    start,
    stop,
    vent,
    release,
    acknowledge,
    events,
    statistics,
    sequences,
    hello,
    subscribe,
    unsubscribe,
  };

  std::optional<std::uint64_t> id;  ///< id of the client, repeated in each reply
  Command command = Command::status;
  double rate_hz = 10;        ///< for watch: [0.1, 50]
  std::string sequence;       ///< for start: a file in the daemon's sequence directory, or ...
  std::string sequence_text;  ///< ... the sequence itself; then `sequence` is its name in messages
  std::vector<control::Argument> parameters;  ///< for start: values that replace defaults
  bool dry_run = false;                       ///< for start: all checks without the motion
  /// The client's id for a start, [1, 64] bytes without control characters; empty: none. Used by start, and
  /// by a stop of this start alone.
  std::string start_id;
  std::optional<std::uint64_t> request;  ///< for stop: number of the one start to stop, [1, 2^32); empty: any
  std::optional<std::uint64_t> since;    ///< for events and subscribe: only events with a larger id
  std::string started_at;                ///< for subscribe: start time of the daemon that gave the ids
  std::string client;                    ///< for hello: name, [1, 64] bytes without control characters
  std::uint64_t api = api_version;       ///< for hello: version of the client
  std::uint64_t limit = 100;             ///< for events: [1, 1000]
  bool histograms = false;               ///< for statistics: include the bins
};

/// The reason why a line was refused.
struct ClientError {
  std::optional<std::uint64_t> id;  ///< id of the request, if it could be read
  std::string message;              ///< one sentence
};

/// Reads one line without its line break. Parsing is strict: an unknown, repeated or missing key, a key of
/// another command, a wrong type and a number out of range are errors.
[[nodiscard]] tl::expected<ClientRequest, ClientError> parse_client_request(std::string_view line);

/// Returns the names of the commands that a role may use.
[[nodiscard]] std::vector<std::string_view> commands_of(Role role);
/// Returns true for commands that only read. Returns false for commands that move, stop or acknowledge.
[[nodiscard]] bool only_looks(ClientRequest::Command command) noexcept;

/// Returns true if the line requests a stop or a vent.
[[nodiscard]] bool is_urgent(std::string_view line);

}  // namespace softgrip::daemon
