#pragma once
// Codes in the registers of softgrip-plc. docs/reference/plc-map.md lists these codes. They are part of the
// public format.

#include <cstdint>

namespace softgrip::plc {

enum class CommandCode : std::uint16_t { none, start, stop, vent, release, acknowledge };
inline constexpr std::uint16_t last_command = 5;

/// The outcome of the command with the counter `done_counter`, or the state of a later command that is still
/// in progress.
enum class Outcome : std::uint16_t {
  none,
  executing,
  accepted,
  refused,  ///< the command was not executed; the register `reason` contains the reason of the refusal
  unknown,  ///< the outcome is unknown, because the daemon stopped or did not respond; the command is not
            ///< sent a second time
};

enum class Reason : std::uint16_t {
  none,
  /// The counter is the first counter after the start of the gateway. It is refused, because an earlier
  /// gateway process may have executed its command.
  first_after_start,
  no_daemon,
  no_such_command,
  no_such_recipe,
  client_silent,
  busy,
  sequence_refused,
  not_allowed,
  no_answer,
  /// The counter is not the newest counter plus 1, or this connection has not written the newest counter.
  not_next,
  refusal = 100,  ///< first code of the daemon's refusals; the code is 100 plus the number of the refusal:
                  ///< 102 for R02
};

/// The codes for the state of the daemon. The value 0 means that no daemon is connected.
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
/// Register value of a quantity that is unknown or not set.
inline constexpr std::uint16_t no_value = 0x8000;

}  // namespace softgrip::plc
