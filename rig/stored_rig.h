#pragma once
// Reads a rig from stored texts of its files, without access to the files.

#include <optional>
#include <vector>

#include "rig/rig_file.h"

namespace softgrip::rig {

/// Reads a rig from the stored texts of its files (RigFile::inputs), without access to the disk. Reports the
/// same problems as load_rig() reports for the files.
[[nodiscard]] std::optional<RigFile> read_stored_rig(const std::vector<InputFile>& inputs,
                                                     document::Problems& problems);

}  // namespace softgrip::rig
