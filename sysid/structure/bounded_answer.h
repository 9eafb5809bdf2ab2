#pragma once
// Plausibility check of a fitted model. In a fit to one stroke, large terms may cancel each other; in the
// next stroke they may not.

#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Simulates the drive of each record twice in succession. Returns true if each response exceeds the range of
/// the record's readings by at most the width of that range. A repeated stroke differs from the first by
/// creep and training, which are smaller than the stroke.
[[nodiscard]] bool stays_bounded(const FitPoint& point, const std::vector<Record>& records);

}  // namespace softgrip::sysid
