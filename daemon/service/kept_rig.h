#pragma once
// Keeps a copy of the rig file that softgripd runs in the runtime folder. After a crash, the safe outputs
// must not depend on later edits of the rig file.

#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Keeps the rig file and every file that it names, in one file of the runtime folder and in one step. It
/// takes the place of what an earlier run of the same rig file kept. Does nothing for a rig that drives no
/// board. The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> keep_rig(const rig::RigFile& rig);

/// Returns the rig as the last softgripd ran it with the rig file `config`. Nothing is returned if that run
/// ended in order with all outputs at their lowest, or if what it kept cannot be read.
[[nodiscard]] std::optional<rig::RigFile> kept_rig(const std::string& config);

/// Forgets it: the outputs are at their lowest, confirmed by the board.
void forget_rig(const std::string& config);

}  // namespace softgrip::daemon
