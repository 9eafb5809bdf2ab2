#pragma once
// The numbers that stand in registers. docs/reference/plc-map.md lists them; they are a contract.

#include <cstdint>

namespace softgrip::plc {

enum class CommandCode : std::uint16_t { none, start, stop, vent, release, acknowledge };
inline constexpr std::uint16_t last_command = 5;

/// The end of the command whose counter is `done_counter`, or a newer one that is under way.
enum class Outcome : std::uint16_t {
  none,
  executing,
  accepted,
  refused,  ///< it was not executed; `reason` gives the cause
  unknown,  ///< the daemon went, or fell silent, before it answered; it is not sent again
};

enum class Reason : std::uint16_t {
  none,
  first_after_start,  ///< the first counter that this gateway saw: an older one may have carried it out
  no_daemon,
  no_such_command,
  no_such_recipe,
  master_silent,
  busy,
  sequence_refused,
  not_allowed,
  no_answer,
  not_next,       ///< the counter does not follow the newest one, or this connection has not written that one
  refusal = 100,  ///< and the daemon's number: 102 is R02
};

/// In which state the daemon is, as registers say it; 0 is no daemon.
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
/// Of a quantity: nothing is known, or nothing is asked for.
inline constexpr std::uint16_t no_value = 0x8000;

}  // namespace softgrip::plc
