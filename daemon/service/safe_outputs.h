#pragma once
// Vents a board for which no daemon runs. After a crash, the setting ExecStopPost= of the systemd unit runs
// this function. A user may run it before work on the rig.

#include <chrono>
#include <string>

#include "base/clock.h"
#include "base/exit_code.h"
#include "drivers/board/board.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Result of the attempt to write the safe outputs.
enum class SafeOutputsEnd {
  confirmed,       ///< the board accepted the rest pressures, and the next exchange confirmed them
  board_holds,     ///< the watchdog of the board has tripped, so the board holds its own safe values
  not_needed,      ///< the service manager reports that softgripd ended in order, so its last outputs remain
  daemon_running,  ///< a daemon responds on the rig's socket, or another program drives the board
  board_silent,    ///< the board did not confirm the rest pressures in time
};

struct SafeOutputsReport {
  SafeOutputsEnd end = SafeOutputsEnd::board_silent;
  std::string text;  ///< the result of the attempt in one sentence
};

/// Returns the exit code for the result of the attempt: 0, 4 or 5. The manual describes these codes.
[[nodiscard]] ExitCode exit_code_of(SafeOutputsEnd end) noexcept;

/// Connects to the board and writes the rest pressure of all channels until two consecutive exchanges have
/// succeeded. If the board map has a read-back, the second exchange confirms the first write. Repeats the
/// attempt until `patience` is over. The phase in which the daemon ended is unknown. Therefore a held part is
/// released, as the board's own watchdog would do.
[[nodiscard]] SafeOutputsReport write_safe_outputs(const rig::RigFile& rig, drivers::Board& board,
                                                   const Clock& clock, std::chrono::nanoseconds patience);

/// Returns false if softgripd ended in order, because in this case its last outputs must remain.
/// `service_result` is the environment variable SERVICE_RESULT, which systemd sets for ExecStopPost=; empty
/// if it is not set.
[[nodiscard]] bool safe_outputs_needed(const std::string& service_result) noexcept;

/// Vents the board of a rig from a process that has not opened the board. Does not vent if a daemon responds
/// on the rig's socket, or if a softgrip program holds the board's lock. Ignores a program whose user is not
/// entitled to the lock, and a program that is stopped or blocked.
[[nodiscard]] SafeOutputsReport vent_rig(const rig::RigFile& rig);

}  // namespace softgrip::daemon
