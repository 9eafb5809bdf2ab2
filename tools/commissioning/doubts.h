#pragma once
// Warns if a valid calibration deviates so far from the previous one that a gauge may have been misread.

#include <string>
#include <vector>

#include "tools/commissioning/snippet.h"

namespace softgrip::tools::calibrate {

/// As a share of the range that the limits allow, or of the model's motion.
inline constexpr double most_share_off = 0.2;

/// Returns one warning per line that deviates from the line of the rig file by more than `most_share_off`.
/// Also warns if the motion of the finger between the two pressures deviates that far from its model. Empty:
/// no warning.
[[nodiscard]] std::vector<std::string> doubts(const rig::RigFile& rig, const Results& results);

}  // namespace softgrip::tools::calibrate
