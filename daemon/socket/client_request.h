#pragma once
// One line of a client of the socket API, read into a plain value. Lines come from outside: this is the
// parser that is fuzzed (tests/daemon/socket/client_request_fuzz.cpp). docs/reference/socket-api.md is the
// manual.

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

  std::optional<std::uint64_t> id;  ///< the client's own, echoed in every reply
  Command command = Command::status;
  double rate_hz = 10;        ///< of watch: [0.1, 50]
  std::string sequence;       ///< of start: a file in the daemon's sequence directory, or ...
  std::string sequence_text;  ///< ... the sequence itself; then `sequence` is its name in messages
  std::vector<control::Argument> parameters;  ///< of start: values in the place of defaults
  bool dry_run = false;                       ///< of start: everything but the motion
  /// The client's own name for a start, [1, 64] bytes without control characters: given by start, and by a
  /// stop of this start alone. Empty: none.
  std::string start_id;
  std::optional<std::uint64_t> request;  ///< of a stop: the number of the only start that it stops, [1, 2^32)
  std::optional<std::uint64_t> since;    ///< of events and subscribe: only those with a larger id
  std::string started_at;                ///< of subscribe: of the daemon whose ids these are; empty: this one
  std::string client;                    ///< of hello: who it is, [1, 64] bytes without control characters
  std::uint64_t api = api_version;       ///< of hello: the version that the client speaks
  std::uint64_t limit = 100;             ///< of events: [1, 1000]
  bool histograms = false;               ///< of statistics: with the bins
};

/// Why a line was refused.
struct ClientError {
  std::optional<std::uint64_t> id;  ///< as far as it could be read
  std::string message;              ///< one sentence
};

/// Reads one line without its line break. Strict: an unknown, repeated or missing key, a key of another
/// command, a wrong type and a number out of range are errors.
[[nodiscard]] tl::expected<ClientRequest, ClientError> parse_client_request(std::string_view line);

/// The names of the commands that a role may use.
[[nodiscard]] std::vector<std::string_view> commands_of(Role role);
/// False of what moves, stops or acknowledges.
[[nodiscard]] bool only_looks(ClientRequest::Command command) noexcept;

/// Returns true if the line requests a stop or a vent.
[[nodiscard]] bool is_urgent(std::string_view line);

}  // namespace softgrip::daemon
