#pragma once
// Plans a sequence before it starts: compares its steps with the limits of a rig, and plans their motion. For
// each channel with the feedforward `planned`, computes the command for each step to a displacement.

#include <stop_token>
#include <vector>

#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "document/problem.h"

namespace softgrip::control {

/// A plan whose displacement differs too much from its reference, because the model cannot follow the
/// reference within the limits.
struct MissedPlan {
  std::size_t step = 0;
  std::size_t channel = 0;
  double rmse_mm = 0;
  double worst_mm = 0;
};

/// Longest planned motion of a channel in one sequence [s]. This limit bounds the computing time of the
/// planning.
inline constexpr double most_planned_s = 600;

/// Computes the plans for the expected execution of the sequence. In this execution, each channel begins at
/// rest under its rest pressure, and no step fails. Each settling time and verification window is as short as
/// possible. The plans use the ChannelPlayer of the control loop, so their references are those that the loop
/// will follow. A plan ends at the next step of its channel. A plan ends at the latest 20 s after the end of
/// its reference; after this time, the last command remains. PlannedFeedforward
/// (control/feedforward/feedforward_kinds.h) handles deviations from the expected execution. The function
/// fills PreparedStep::plans and PreparedSequence::planned_s. If the planned motion is longer than
/// most_planned_s, the function fills only planned_s. After a request through `stop`, the function returns
/// soon, and the sequence must not be used.
[[nodiscard]] std::vector<MissedPlan> plan_steps(PreparedSequence& sequence, const RigSettings& settings,
                                                 const std::stop_token& stop = {});

/// Finds the channels of the steps by their names, and adds a problem for each step that does not fit the
/// rig. If a problem was added, the result is not usable. This function computes no plan.
[[nodiscard]] PreparedSequence fit_to_rig(const Sequence& sequence, const RigSettings& settings,
                                          document::Problems& problems);

/// Plans the motion of the channels with the feedforward `planned` (control/sequences/sequence_plans.h). A
/// planned position that is out of reach is a warning. The function adds a problem in two cases: the planned
/// motion of a channel is longer than most_planned_s, or `stop` requests the end of the computation.
/// @param prepared  result of fit_to_rig() for this sequence.
void plan_motion(const Sequence& sequence, const RigSettings& settings, PreparedSequence& prepared,
                 document::Problems& problems, const std::stop_token& stop);

}  // namespace softgrip::control
