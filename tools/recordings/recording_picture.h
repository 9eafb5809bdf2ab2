#pragma once
// The picture of a recording: per channel pressure, displacement and tracking error, and what the rig did.

#include <string>

#include "tools/recordings/recording.h"

namespace softgrip::tools {

/// The whole picture as an SVG document.
[[nodiscard]] std::string picture_of(const Recording& recording);

}  // namespace softgrip::tools
