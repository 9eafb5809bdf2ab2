#pragma once
// Finds a wrong command at the beginning of a log, for example the default value of a register.

#include <cstddef>
#include <optional>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// A wrong command in the samples 0 to `samples` - 1.
struct WrongFirstCommand {
  std::size_t samples = 0;
  double command_kpa = 0;  ///< wrong command
  double next_kpa = 0;     ///< command after it
};

/// Returns the wrong command at the beginning of the log, or nullopt. A log may correctly begin with the
/// command before a step. The first command is therefore wrong only if these conditions are met:
/// - It is held for at most 4 samples, and the next command for at least 20 samples.
/// - The two commands differ by more than 10 % of the range of all other commands.
/// - The first readings are nearer to the readings under the second command in the rest of the log than to
/// the
///   readings under the first command.
[[nodiscard]] std::optional<WrongFirstCommand> wrong_first_command(const Log& log);

}  // namespace softgrip::sysid
