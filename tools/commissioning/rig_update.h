#pragma once
// Writes the results of a calibration into the rig file.

#include <string>

#include <tl/expected.hpp>

#include "tools/commissioning/snippet.h"

namespace softgrip::tools::calibrate {

/// Returns the text of the rig file with the new points of the calibrated maps. All other lines, including
/// comments, stay unchanged. A comment above each map states the date and the error of the calibration.
/// `channel_defaults` is not changed: the new points are added to the channel. The new text has passed the
/// rig-file reader. The error is a sentence that says why a person must insert the lines.
[[nodiscard]] tl::expected<std::string, std::string> updated_rig(const std::string& text,
                                                                 const rig::RigFile& rig,
                                                                 const Results& results);

/// Replaces the text of the file from which `rig` was read by `text`, and keeps a copy of the old file in the
/// same folder. Returns the path of the copy. If the file has changed since it was read, or if a step fails,
/// the rig file stays unchanged.
[[nodiscard]] tl::expected<std::string, std::string> write_rig(const rig::RigFile& rig,
                                                               const std::string& text);

}  // namespace softgrip::tools::calibrate
