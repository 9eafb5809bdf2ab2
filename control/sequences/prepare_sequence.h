#pragma once
// Fits a sequence to a rig: resolves the names of channels and checks all values against the limits of the
// rig.

#include <optional>
#include <stop_token>

#include "control/tick/sequence.h"
#include "document/problem.h"

namespace softgrip::control {

/// Fits a sequence to a rig, and plans the motion of the channels that use the feedforward `planned`
/// (control/sequences/sequence_plans.h). Adds each step that does not fit to `problems` and then returns
/// nullopt. A planned position that is out of reach is a warning. Returns nullopt also if `stop` ends the
/// planning.
[[nodiscard]] std::optional<PreparedSequence> prepare(const Sequence& sequence, const RigSettings& settings,
                                                      document::Problems& problems,
                                                      const std::stop_token& stop = {});

/// Checks the ends of the ranges of the sequence's parameters against the rig, one parameter at a time. Each
/// problem is reported at the parameter. Nothing is planned.
void check_ranges(const Sequence& sequence, const RigSettings& settings, document::Problems& problems);

}  // namespace softgrip::control
