#pragma once
// Vents a board for which no daemon runs. The unit's ExecStopPost= does this after a crash; a user may do it
// before work on the rig.

#include <chrono>
#include <string>

#include "base/clock.h"
#include "base/exit_code.h"
#include "drivers/board/board.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Result of the attempt.
enum class SafeOutputsEnd {
  confirmed,       ///< the board accepted the rest pressures, and the next exchange confirmed them
  board_holds,     ///< the board's own watchdog has tripped and holds its safe values
  not_needed,      ///< the service manager reports that softgripd ended in order
  daemon_running,  ///< a daemon responds on the rig's socket, or another program drives the board
  board_silent,    ///< the board did not confirm the rest pressures in time
};

struct SafeOutputsReport {
  SafeOutputsEnd end = SafeOutputsEnd::board_silent;
  std::string text;  ///< one sentence
};

/// Returns the exit code 0, 4 or 5. The manual describes these codes.
[[nodiscard]] ExitCode exit_code_of(SafeOutputsEnd end) noexcept;

/// Connects and writes the rest pressure of all channels until two consecutive exchanges have succeeded. In
/// the second exchange, the board confirms the first write if its map has a read-back. Repeats this until
/// `patience` is over. The phase in which the daemon ended is unknown, so a held part is released, as the
/// board's own watchdog would do.
[[nodiscard]] SafeOutputsReport write_safe_outputs(const rig::RigFile& rig, drivers::Board& board,
                                                   const Clock& clock, std::chrono::nanoseconds patience);

/// Returns false if softgripd ended in order, because its last outputs then remain. `service_result`:
/// environment variable SERVICE_RESULT, which systemd sets for ExecStopPost=; empty if it is not set.
[[nodiscard]] bool safe_outputs_needed(const std::string& service_result) noexcept;

/// Vents the board of a rig for a process that has not opened it. Yields to a daemon that responds on the
/// rig's socket, and to a softgrip program that holds the board's lock. Ignores a program of a user without
/// the right to the lock, and a program that does not respond.
[[nodiscard]] SafeOutputsReport vent_rig(const rig::RigFile& rig);

}  // namespace softgrip::daemon
