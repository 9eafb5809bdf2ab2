#pragma once
// Stores the signal that requested the end of this process. The process ends by this signal after it has
// cleaned up.
//
// A shell ends a loop in a script on Ctrl-C only if the signal itself ended the running program. If the
// program returned an ordinary exit code, the loop would start the next program.

#include <string>

namespace softgrip {

/// Stores the signal by which the process must end. If a signal is already stored, the call has no effect.
/// Any thread may call this function.
void note_ending_signal(int signal) noexcept;

/// Returns the stored signal; 0 if no signal is stored.
[[nodiscard]] int ending_signal() noexcept;

/// Returns the name of a signal, such as "SIGINT". If the signal has no name, returns a text with its number,
/// such as "signal 35".
[[nodiscard]] std::string name_of_signal(int signal);

/// Flushes the standard streams and ends the process by `signal` with its default disposition. Call this
/// function after the outputs are safe and all files are closed.
[[noreturn]] void end_by_signal(int signal) noexcept;

}  // namespace softgrip
