#pragma once
// A record thinned so that its samples stand for the intervals around them.

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The first sample, and of every interval of such a length, counted from it, the sample that is nearest to
/// its middle: what is reckoned there stands for the interval's mean, but for how much it bends in it. A
/// record that is coarser already stays as it is.
[[nodiscard]] Record thinned_to_centres(const Record& record, double interval_s);

}  // namespace softgrip::sysid
