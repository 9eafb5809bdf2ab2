#pragma once
// Reads one line of a client of the socket API into a plain value. Any user of the socket can send lines, so
// this parser is fuzz-tested (tests/daemon/socket/client_request_fuzz.cpp). docs/reference/socket-api.md
// describes the requests.
// Defines the roles of the clients of the socket API. The socket to which a client is connected determines
// the role of the client.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/enum_table.h"
#include "control/tick/sequence.h"

namespace softgrip::daemon {

enum class Role : std::uint8_t {
  look,     ///< read-only; for clients of the socket `socket: read_only:` of the rig file
  operate,  ///< may move the gripper; for clients of the socket `socket: path:` of the rig file
};
/// Names of the roles in replies.
inline constexpr auto role_names = enum_names<Role>({{Role::look, "look"}, {Role::operate, "operate"}});
[[nodiscard]] constexpr std::string_view name_of(Role role) noexcept {
  return role_names[role];
}

/// Version of the socket API that this daemon implements.
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

  std::optional<std::uint64_t> id;  ///< id that the client gave the request; each reply repeats it
  Command command = Command::status;
  double rate_hz = 10;        ///< for watch: messages per second, 0.1 to 50
  std::string sequence;       ///< for start: name of a file in the daemon's sequence directory
  std::string sequence_text;  ///< for start: text of the sequence itself; messages then use `sequence` as its
                              ///< name
  std::vector<control::Argument> parameters;  ///< for start: values that replace the defaults of the
                                              ///< parameters
  bool dry_run = false;  ///< true: the request `start` makes all checks of the start, but starts no motion
                         ///< (dry run)
  /// for start and stop: the client's id for a start, 1 to 64 bytes without control characters; empty: the
  /// client gave no id. A stop with this id stops the start with this id and no other start.
  std::string start_id;
  std::optional<std::uint64_t> request;  ///< for stop: id of the start request to stop, from 1 to 2^32 - 1;
                                         ///< empty: any start is stopped
  std::optional<std::uint64_t> since;  ///< for events and subscribe: the daemon sends the events whose id is
                                       ///< larger than this id
  std::string started_at;  ///< for subscribe: start time of the daemon that assigned the event ids that the
                           ///< client knows
  std::string client;      ///< for hello: name of the client, 1 to 64 bytes without control
                           ///< characters
  std::uint64_t api = api_version;  ///< for hello: version of the socket API that the client uses
  std::uint64_t limit = 100;        ///< for events: largest number of events, 1 to 1000
  bool histograms = false;  ///< for statistics; if true, the reply contains the bins of the histograms
};

/// The reason why a line was refused.
struct ClientError {
  std::optional<std::uint64_t> id;  ///< id of the refused request; empty if the id could not be read
  std::string message;              ///< reason of the refusal in one sentence
};

/// Reads one line without its line break. Parsing is strict. An unknown, repeated or missing key, a key of
/// another command, a wrong type and a number out of range are errors.
[[nodiscard]] tl::expected<ClientRequest, ClientError> parse_client_request(std::string_view line);

/// Returns the names of the commands that a role may use.
[[nodiscard]] std::vector<std::string_view> commands_of(Role role);
/// Returns true for a command that only reads data. Returns false for a command that moves, stops or resets a
/// part of the rig.
[[nodiscard]] bool is_read_only(ClientRequest::Command command) noexcept;

/// Returns true if the line is a request to stop or to vent.
[[nodiscard]] bool is_urgent(std::string_view line);

}  // namespace softgrip::daemon
