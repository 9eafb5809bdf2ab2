#pragma once
// Warns of values in a rig file that are permitted but implausible, by comparing limits and model.

#include <cstddef>

#include "control/tick/sequence.h"
#include "document/node.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

/// Adds a warning with a proposed value, at the key that should change, in these cases:
/// - the highest pressure moves the model's free finger to at least twice its displacement limit;
/// - a plausible reading may have at least ten times the speed of the model within its slew limits;
/// - a burst line would not be detected: no pressure monitor, or no comparison of pressure and command.
///
/// Simulates each model for several seconds of model time. `document` is the source of `rig`.
void compare_limits(const document::Document& document, const RigFile& rig, document::Problems& problems);

/// Returns true if a burst line or a lost supply on this channel would be a fault.
[[nodiscard]] bool sees_burst_line(const RigFile& rig, std::size_t channel);

/// Adds a warning at the first grip step that would report HOLDING by displacement although a burst line of
/// the finger is not detectable. At most one warning per sequence.
void compare_grips(const control::Sequence& sequence, const RigFile& rig, document::Problems& problems);

}  // namespace softgrip::rig
