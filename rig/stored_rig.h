#pragma once
// A rig out of the files as they were read before, without a look at the disk.

#include <optional>
#include <vector>

#include "rig/rig_file.h"

namespace softgrip::rig {

/// Reads a rig again from the files that it was read from (RigFile::inputs). Does not look at the disk.
/// Problems are those of load_rig().
[[nodiscard]] std::optional<RigFile> read_stored_rig(const std::vector<InputFile>& inputs,
                                                     document::Problems& problems);

}  // namespace softgrip::rig
