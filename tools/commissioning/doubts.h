#pragma once
// A calibration that is possible, and yet so far off what was believed that a gauge may have been misread.

#include <string>
#include <vector>

#include "tools/commissioning/snippet.h"

namespace softgrip::tools::calibrate {

/// Of the range that the limits allow, or of the model's motion.
inline constexpr double most_share_off = 0.2;

/// One sentence for every line that is farther than that off the old one of the rig file, and for a finger
/// that moved so much more or less between the two pressures than its model says; empty: nothing is odd.
[[nodiscard]] std::vector<std::string> doubts(const rig::RigFile& rig, const Results& results);

}  // namespace softgrip::tools::calibrate
