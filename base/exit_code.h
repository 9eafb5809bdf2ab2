#pragma once
// Defines the exit codes of all programs of the project.
// Checks that a program could write its results to the standard output.
// Stores the signal that requested the end of this process. The process ends by this signal after it has
// cleaned up.
//
// A shell ends a loop in a script on Ctrl-C only if the signal itself ended the running program. If the
// program returned an ordinary exit code, the loop would start the next program.

#include <string>

namespace softgrip {

enum class ExitCode : int {
  done = 0,
  failed = 1,
  usage = 2,
  input_refused = 3,   ///< a configuration, model, log or sequence was refused
  io = 4,              ///< a file, the socket of the daemon or a network address caused an error
  state_refused = 5,   ///< the state of the daemon does not permit the command
  not_acceptable = 6,  ///< the command finished, but the result does not meet the requirement of the user
};

/// Flushes the standard output at the end of a program. Returns `code` if all output was written. If output
/// was lost (a full disk, a closed pipe), prints a message to the standard error, and returns `io` if `code`
/// is `done`.
[[nodiscard]] ExitCode with_output_checked(ExitCode code, const char* program) noexcept;

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
