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
  unknown,  ///< the daemon stopped or fell silent before its response; the command is not sent again
};

enum class Reason : std::uint16_t {
  none,
  first_after_start,  ///< the first counter after the gateway's start: an older gateway may have executed it
  no_daemon,
  no_such_command,
  no_such_recipe,
  master_silent,
  busy,
  sequence_refused,
  not_allowed,
  no_answer,
  not_next,       ///< the counter does not follow the newest one, or this connection did not write that one
  refusal = 100,  ///< plus the daemon's number: 102 is R02
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
