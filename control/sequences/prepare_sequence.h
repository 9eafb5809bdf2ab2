#pragma once
// Fits a sequence to a rig.

#include <optional>
#include <stop_token>

#include "control/tick/sequence.h"
#include "document/problem.h"

namespace softgrip::control {

/// Fits a sequence to a rig, and plans its motion for the channels that want it
/// (control/sequences/sequence_plans.h). What does not fit is added to `problems`, each at its step; nothing
/// is returned then. What is planned but out of reach is a warning. Planning can be asked to stop; then
/// nothing is returned, for that reason.
[[nodiscard]] std::optional<PreparedSequence> prepare(const Sequence& sequence, const RigSettings& settings,
                                                      document::Problems& problems,
                                                      const std::stop_token& stop = {});

/// Adds what does not fit the rig at the ends of the ranges of the sequence's parameters, one parameter after
/// the other, each at the parameter. Nothing is planned.
void check_ranges(const Sequence& sequence, const RigSettings& settings, document::Problems& problems);

}  // namespace softgrip::control
