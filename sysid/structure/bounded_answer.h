#pragma once
// Checks whether a fitted model is plausible. In a fit to a single stroke, large terms of the model may
// cancel each other. In the next stroke, they may not cancel.

#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Simulates the drive of each record twice in succession. Returns true if the response to each record stays
/// within the range of the readings, extended on both sides by the width of this range. A repeated stroke
/// differs from the first one only by creep and training, which are smaller than the stroke.
[[nodiscard]] bool stays_bounded(const FitPoint& point, const std::vector<Record>& records);

}  // namespace softgrip::sysid
