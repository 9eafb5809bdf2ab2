#pragma once
// Keeps a copy of softgripd's rig file in the runtime folder while softgripd runs. After a crash, the copy
// ensures that the safe outputs do not depend on later edits of the rig file.

#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Copies the rig file and all files that it names into one file of the runtime folder, in one step. The new
/// copy replaces the copy of an earlier run with the same rig file. Does nothing for a rig that has no real
/// board. The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> keep_rig(const rig::RigFile& rig);

/// Returns the rig that the last softgripd with the rig file `config` used. Returns nothing if that softgripd
/// ended in order with all outputs at rest, or if the copy cannot be read.
[[nodiscard]] std::optional<rig::RigFile> kept_rig(const std::string& config);

/// Removes the copy of the rig. Call this function after the board has confirmed that all outputs are at
/// rest.
void forget_rig(const std::string& config);

}  // namespace softgrip::daemon
