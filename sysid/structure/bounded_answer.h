#pragma once
// A fit to one stroke may cancel large terms against each other that the next stroke does not cancel.

#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if the answer to the drive of every record, and to the same drive once more behind it, leaves
/// the range of the record's readings by no more than the width of that range. A repeated stroke differs from
/// the first by creep and training, which are less than the stroke.
[[nodiscard]] bool stays_bounded(const FitPoint& point, const std::vector<Record>& records);

}  // namespace softgrip::sysid
