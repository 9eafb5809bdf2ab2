#pragma once
// Checks the plausibility of a fitted model. In a fit to a single stroke, large terms may cancel each other,
// but they may not cancel in the next stroke.

#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Simulates the drive of each record twice in succession. Returns true if each response stays within the
/// range of the readings, extended on both sides by the width of this range. A repeated stroke may differ
/// from the first one by creep and training, which are smaller than the stroke.
[[nodiscard]] bool stays_bounded(const FitPoint& point, const std::vector<Record>& records);

}  // namespace softgrip::sysid
