#pragma once
// Defines the exit codes of all programs of the project.

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

}  // namespace softgrip
