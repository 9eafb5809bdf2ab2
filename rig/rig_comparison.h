#pragma once
// Compares the limits of a rig file with the models, and warns of values that are permitted but implausible.

#include <cstddef>

#include "control/tick/sequence.h"
#include "document/node.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

/// In each of the following cases, adds a warning with a proposed value at the key that should be changed:
/// - at a pressure limit, the free finger of the model goes more than twice as far as its displacement limit;
/// - `max_speed_mm_per_s` is at least ten times the speed of the model within its slew limits;
/// - a burst pressure line would not be detected, because the channel has no pressure monitor, or because the
///   measured pressure is not compared with the command.
///
/// The function simulates several seconds of each model. `document` is the document from which `rig` was
/// read.
void compare_limits(const document::Document& document, const RigFile& rig, document::Problems& problems);

/// Returns true if a burst pressure line or a lost supply of this channel would cause a fault.
[[nodiscard]] bool sees_burst_line(const RigFile& rig, std::size_t channel);

/// Adds a warning at the first grip step that verifies its result by displacement or detection, if a burst
/// pressure line is not detected on the channel of the step. With a burst line, this step would report
/// HOLDING. Adds at most one warning per sequence.
void compare_grips(const control::Sequence& sequence, const RigFile& rig, document::Problems& problems);

}  // namespace softgrip::rig
