#pragma once
// Compares the steps of a sequence with the limits of a rig, and plans the motion of the steps.

#include <stop_token>

#include "control/tick/sequence.h"
#include "document/problem.h"

namespace softgrip::control {

/// Finds the channels of the steps by their names, and adds a problem for each step that does not fit the
/// rig. If a problem was added, the result is not usable. This function computes no plan.
[[nodiscard]] PreparedSequence fit_to_rig(const Sequence& sequence, const RigSettings& settings,
                                          document::Problems& problems);

/// Plans the motion of the channels with the feedforward `planned` (control/sequences/sequence_plans.h). A
/// planned position that is out of reach is a warning. The function adds a problem in two cases: a plan is
/// longer than most_planned_s, or `stop` requests the end of the computation.
/// @param prepared  result of fit_to_rig() for this sequence.
void plan_motion(const Sequence& sequence, const RigSettings& settings, PreparedSequence& prepared,
                 document::Problems& problems, const std::stop_token& stop);

}  // namespace softgrip::control
