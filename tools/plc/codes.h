#pragma once
// The codes in the registers. docs/reference/plc-map.md lists them. They are part of the public format.

#include <cstdint>

namespace softgrip::plc {

enum class CommandCode : std::uint16_t { none, start, stop, vent, release, acknowledge };
inline constexpr std::uint16_t last_command = 5;

/// The outcome of the command with the counter `done_counter`, or the state of a newer command in progress.
enum class Outcome : std::uint16_t {
  none,
  executing,
  accepted,
  refused,  ///< not executed; `reason` gives the cause
  unknown,  ///< the daemon stopped or fell silent before it responded; the command is not sent again
};

enum class Reason : std::uint16_t {
  none,
  /// First counter after the gateway's start; an earlier gateway process may have executed its command.
  first_after_start,
  no_daemon,
  no_such_command,
  no_such_recipe,
  master_silent,
  busy,
  sequence_refused,
  not_allowed,
  no_answer,
  /// The counter does not follow the newest one, or this connection has not written the newest one.
  not_next,
  refusal = 100,  ///< a refusal of the daemon: 100 plus its number, for example 102 for R02
};

/// The state of the daemon in the registers. 0 means no daemon.
enum class StateCode : std::uint16_t {
  no_daemon,
  starting,
  idle,
  resynchronising,
  running,
  stopping,
  faulted
};

inline constexpr std::uint16_t version_of_map = 1;
/// The value of a quantity that is unknown or not set.
inline constexpr std::uint16_t no_value = 0x8000;

}  // namespace softgrip::plc
