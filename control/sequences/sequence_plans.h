#pragma once
// The plans of a sequence: for every channel with feedforward `planned`, the command for each step that moves
// it to a displacement, computed before the sequence starts.

#include <stop_token>
#include <vector>

#include "control/tick/sequence.h"
#include "control/tick/settings.h"

namespace softgrip::control {

/// A plan that will be missed: its model cannot follow the reference within the limits.
struct MissedPlan {
  std::size_t step = 0;
  std::size_t channel = 0;
  double rmse_mm = 0;
  double worst_mm = 0;
};

/// The longest motion of a channel that is planned for one sequence [s]. With it the time that planning takes
/// has a bound.
inline constexpr double most_planned_s = 600;

/// The sequence is walked through once as it should go: every channel begins at rest under its lowest
/// command, no step fails, every settling time and every window takes what it must and nothing is waited for.
/// The player of the loop makes the references, so the plans are for what will be followed. A plan reaches
/// until the channel's next step, over a hold of any length for 20 s at most; after it the last command
/// stays. PlannedFeedforward (control/feedforward/feedforward_kinds.h) handles every deviation from it. Fills
/// PreparedStep::plans and PreparedSequence::planned_s; of a sequence with more than most_planned_s the
/// latter only. Asked to stop it returns soon, and the sequence is not to be used.
[[nodiscard]] std::vector<MissedPlan> plan_steps(PreparedSequence& sequence, const RigSettings& settings,
                                                 const std::stop_token& stop = {});

}  // namespace softgrip::control
