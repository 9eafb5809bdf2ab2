#pragma once
// Vents a board without a daemon: what the unit's ExecStopPost= does after a crash, and a hand may do before
// work on the rig.

#include <chrono>
#include <string>

#include "base/clock.h"
#include "base/exit_code.h"
#include "drivers/board/board.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Result of the attempt.
enum class SafeOutputsEnd {
  confirmed,       ///< the board took the rest pressure of every channel, and the next exchange confirmed it
  board_holds,     ///< the board's own watchdog has tripped and holds its safe values
  not_needed,      ///< the service manager says that softgripd ended in order
  daemon_running,  ///< a daemon answers on the rig's socket, or another program drives the board: it would
                   ///< write something else in a moment
  board_silent,    ///< nothing confirmed within the time
};

struct SafeOutputsReport {
  SafeOutputsEnd end = SafeOutputsEnd::board_silent;
  std::string text;  ///< one sentence
};

/// 0, 4 or 5: see the exit codes of the manual.
[[nodiscard]] ExitCode exit_code_of(SafeOutputsEnd end) noexcept;

/// Connects and writes the rest pressure of every channel until two exchanges in a row succeeded. In the
/// second one, the board repeats the first write if its map has a read-back. Tries again until `patience` is
/// over. The phase of the daemon is unknown then, so a held part is released, as by the board's own watchdog.
[[nodiscard]] SafeOutputsReport write_safe_outputs(const rig::RigFile& rig, drivers::Board& board,
                                                   const Clock& clock, std::chrono::nanoseconds patience);

/// False after an orderly end, whose outputs stay. `service_result`: the environment variable SERVICE_RESULT
/// that systemd gives to ExecStopPost=, empty without it.
[[nodiscard]] bool safe_outputs_needed(const std::string& service_result) noexcept;

/// Vents for a process that has no board yet. Yields to a daemon that answers on the rig's socket and to a
/// softgrip program that holds the board's lock. A program of a user without the right to the lock does not
/// count, nor one that does not answer.
[[nodiscard]] SafeOutputsReport vent_rig(const rig::RigFile& rig);

}  // namespace softgrip::daemon
