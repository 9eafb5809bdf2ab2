#pragma once
// A record thinned to every so many samples.

#include <cstddef>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Every `stride`-th sample of a record, from the first on: for a first look at many starts. A command that
/// is held is the mean of what was held; one that jumps between two samples keeps its mean around them, since
/// the jump would come up to a whole interval early or late; corners without a jump stay as sharp as they
/// are.
[[nodiscard]] Record thinned_record(const Record& record, std::size_t stride);
/// Thinned so that samples stand at most `interval_s` apart, where they are not farther apart already.
[[nodiscard]] Record thinned_to(const Record& record, double interval_s);
/// Thinned likewise, and each reading the mean of those that are nearer to it than to any other that is left:
/// their noise falls with the root of their number. A motion is not blurred as long as it bends little within
/// `interval_s`.
[[nodiscard]] Record averaged_to(const Record& record, double interval_s);

}  // namespace softgrip::sysid
