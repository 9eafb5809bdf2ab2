#pragma once
// The signal that asked this process to end, kept until everything is in order.
//
// A shell ends its loop only if the program died by the signal. A program that answers Ctrl-C with an exit
// code of its own lets the loop start the next program.

#include <string>

namespace softgrip {

/// Records the signal by which the process shall end. The first one is kept. Safe in any thread.
void note_ending_signal(int signal) noexcept;

/// Returns the recorded signal, or 0.
[[nodiscard]] int ending_signal() noexcept;

/// "SIGINT", or "signal 35" of one without a name.
[[nodiscard]] std::string name_of_signal(int signal);

/// Flushes the standard streams and ends the process by `signal` with its default disposition. Call it when
/// the outputs are safe and all files are closed.
[[noreturn]] void end_by_signal(int signal) noexcept;

}  // namespace softgrip
