#pragma once
// Checks that precede any motion in a command that plays experiments on the rig of a rig file.

#include <string>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Returns a function that requests consent on the terminal. With `yes`, the function always consents.
[[nodiscard]] Consent consent_on_terminal(bool yes);

/// Opens the rig of a file and selects a channel; "" selects the only channel. Prints the reason and returns
/// an exit code in four cases. The file is unreadable or invalid. The channel does not exist. No terminal is
/// available for the consent. softgripd or another program uses the board, which is impossible for a rig that
/// is simulated in the process.
[[nodiscard]] tl::expected<ExperimentRig, ExitCode> rig_to_move(const std::string& path,
                                                                const std::string& channel, bool yes);

}  // namespace softgrip::tools
