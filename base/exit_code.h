#pragma once
// Exit codes of all programs of the project.

namespace softgrip {

enum class ExitCode : int {
  done = 0,
  failed = 1,
  usage = 2,
  input_refused = 3,   ///< a configuration, model, log or sequence was refused
  io = 4,              ///< an error of a file, of the daemon's socket or of a network address
  state_refused = 5,   ///< the state of the daemon does not permit the command
  not_acceptable = 6,  ///< finished, but the result does not meet the requirement of the user
};

}  // namespace softgrip
