#pragma once
// What every command that plays experiments on a rig file's rig asks before anything moves.

#include <string>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Asks on the terminal; with `yes` everything is allowed.
[[nodiscard]] Consent consent_on_terminal(bool yes);

/// The rig of a file, one channel chosen ("": its only one). What stands in the way is printed: a file that
/// cannot be read or is refused, no such channel, nobody who could be asked, a softgripd or another program
/// on the board. A simulated rig, in process, is nobody else's.
[[nodiscard]] tl::expected<ExperimentRig, ExitCode> rig_to_move(const std::string& path,
                                                                const std::string& channel, bool yes);

}  // namespace softgrip::tools
