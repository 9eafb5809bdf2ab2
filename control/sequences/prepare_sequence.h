#pragma once
// Fits a sequence to a rig: finds the channels by their names and compares all values with the limits of the
// rig.

#include <optional>
#include <stop_token>

#include "control/tick/sequence.h"
#include "document/problem.h"

namespace softgrip::control {

/// Fits a sequence to a rig, and plans the motion of the channels with the feedforward `planned`
/// (control/sequences/sequence_plans.h). Adds a problem for each step that does not fit the rig. A planned
/// position that is out of reach is a warning. Returns nullopt if a step does not fit, or if a request
/// through `stop` ends the planning.
[[nodiscard]] std::optional<PreparedSequence> prepare(const Sequence& sequence, const RigSettings& settings,
                                                      document::Problems& problems,
                                                      const std::stop_token& stop = {});

/// Checks the lowest and the highest value of each parameter against the rig, one parameter at a time. Each
/// problem is reported at its parameter. This check computes no plan.
void check_ranges(const Sequence& sequence, const RigSettings& settings, document::Problems& problems);

}  // namespace softgrip::control
