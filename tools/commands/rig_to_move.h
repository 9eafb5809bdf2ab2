#pragma once
// The checks of every command that plays experiments on the rig of a rig file, before any motion.

#include <string>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Requests consent on the terminal. With `yes`, everything is allowed.
[[nodiscard]] Consent consent_on_terminal(bool yes);

/// Opens the rig of a file and selects a channel ("" selects the only channel). Prints the reason and returns
/// an exit code in these cases: the file is unreadable or invalid, the channel does not exist, no terminal is
/// available for the consent, or softgripd or another program uses the board. A rig that is simulated in the
/// process is always free.
[[nodiscard]] tl::expected<ExperimentRig, ExitCode> rig_to_move(const std::string& path,
                                                                const std::string& channel, bool yes);

}  // namespace softgrip::tools
