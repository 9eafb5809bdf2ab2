#pragma once
// Warns if a valid calibration deviates so far from the previous calibration that a gauge may have been
// misread.

#include <string>
#include <vector>

#include "tools/commissioning/snippet.h"

namespace softgrip::tools::calibrate {

/// Largest deviation that causes no warning, as a share of the range between the limits or of the motion that
/// the model predicts.
inline constexpr double most_share_off = 0.2;

/// Compares each calibrated line with the line in the rig file. Returns one warning for each line whose
/// deviation exceeds `most_share_off`. Also warns if the motion of the finger between the two pressures
/// deviates by more than this share from the motion of its model. The list is empty if there is no warning.
[[nodiscard]] std::vector<std::string> plausibility_warnings(const rig::RigFile& rig, const Results& results);

}  // namespace softgrip::tools::calibrate
