#pragma once
// A calibration's results written into the rig file itself.

#include <string>

#include <tl/expected.hpp>

#include "tools/commissioning/snippet.h"

namespace softgrip::tools::calibrate {

/// The text of the rig file with the two points of what was calibrated in the place of the old ones; its
/// other lines stay as they are, comments included, and a comment above each map says when and how well it
/// was calibrated. What all channels share (`channel_defaults`) is not changed: the channel gets its own
/// points. The text was read back and says what it should; the error is one sentence: why the lines must be
/// put there by hand.
[[nodiscard]] tl::expected<std::string, std::string> updated_rig(const std::string& text,
                                                                 const rig::RigFile& rig,
                                                                 const Results& results);

/// Writes `text` in the place of the rig file that `rig` was read from, and the old one beside it; returns
/// the path of the old one. A file that has changed since it was read is left alone, and so is it whatever
/// fails.
[[nodiscard]] tl::expected<std::string, std::string> write_rig(const rig::RigFile& rig,
                                                               const std::string& text);

}  // namespace softgrip::tools::calibrate
