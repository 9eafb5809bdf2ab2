#pragma once
// Warns of values in a rig file that are permitted but implausible, by comparing limits and model.

#include <cstddef>

#include "control/tick/sequence.h"
#include "document/node.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

/// Adds a warning with a proposed value, at the key that should change, in these cases:
/// - at a pressure limit, the free finger of the model goes more than twice as far as its displacement limit;
/// - `max_speed_mm_per_s` is at least ten times the speed of the model within its slew limits;
/// - a burst line would not be detected, because the channel has no pressure monitor, or because the measured
///   pressure is not compared with the command.
///
/// The function simulates each model for several seconds of model time. `document` is the source of `rig`.
void compare_limits(const document::Document& document, const RigFile& rig, document::Problems& problems);

/// Returns true if a burst line or a lost supply on this channel would be a fault.
[[nodiscard]] bool sees_burst_line(const RigFile& rig, std::size_t channel);

/// Adds a warning at the first grip step that verifies its result by displacement on a channel without
/// detection of a burst line. Such a step would report HOLDING with a burst line. Adds at most one warning
/// per sequence.
void compare_grips(const control::Sequence& sequence, const RigFile& rig, document::Problems& problems);

}  // namespace softgrip::rig
