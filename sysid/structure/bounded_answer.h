#pragma once
// Tests if the predictions of a fitted model stay plausible beyond the data. In a fit to a single stroke,
// large terms of the model may cancel each other. During a second stroke, the same terms may no longer
// cancel.

#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Simulates the drive of each record twice in succession. Returns true if the response to each record stays
/// within the range of its readings, extended on both sides by the width of this range. Only creep and
/// training can make the second stroke differ from the first one, and both effects are smaller than a stroke.
[[nodiscard]] bool stays_bounded(const FitPoint& point, const std::vector<Record>& records);

}  // namespace softgrip::sysid
