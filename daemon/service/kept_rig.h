#pragma once
// Keeps a copy of the rig file that softgripd runs in the runtime folder. After a crash, the safe outputs
// must not depend on later edits of the rig file.

#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Copies the rig file and all files that it names into one file of the runtime folder, in one step. The copy
/// replaces that of an earlier run with the same rig file. Does nothing for a rig without a real board. The
/// error is a sentence.
[[nodiscard]] tl::expected<void, std::string> keep_rig(const rig::RigFile& rig);

/// Returns the rig that the last softgripd with the rig file `config` used. Returns nothing if that run ended
/// in order with all outputs at rest, or if the copy cannot be read.
[[nodiscard]] std::optional<rig::RigFile> kept_rig(const std::string& config);

/// Removes the copy, after the board has confirmed that all outputs are at rest.
void forget_rig(const std::string& config);

}  // namespace softgrip::daemon
