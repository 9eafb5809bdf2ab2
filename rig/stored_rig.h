#pragma once
// Reads a rig from stored texts of its files, in place of the files.

#include <optional>
#include <vector>

#include "rig/rig_file.h"

namespace softgrip::rig {

/// Reads a rig from the texts of its files (RigFile::inputs). The disk is not accessed. The returned problems
/// equal the problems that load_rig() returns.
[[nodiscard]] std::optional<RigFile> read_stored_rig(const std::vector<InputFile>& inputs,
                                                     document::Problems& problems);

}  // namespace softgrip::rig
