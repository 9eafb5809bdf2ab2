#pragma once
// Measures how much less the healthy logs determine the response to the input of the later logs. Models that
// predict the healthy runs within their spread can give different predictions for an input unlike the healthy
// ones. The predictions depend on the input and on the estimated state at the start of a log, and not on
// later readings.

#include <vector>

#include "sysid/changes/base.h"
#include "sysid/changes/change.h"
#include "sysid/changes/healthy_runs.h"

namespace softgrip::sysid {

/// Returns the disagreement about the later records beyond the largest one that is expected about another
/// healthy run (run_to_run_factor()). If there are several alternatives, the largest value is returned. The
/// result is zero for an input like the healthy inputs. The permitted error then stays unchanged.
/// @param later  later records at the full sampling rate.
[[nodiscard]] Disagreement added_disagreement(const Base& base, const std::vector<Record>& later);

/// Returns true if the input of the later logs increases the permitted error so much that the answer states
/// it.
[[nodiscard]] bool has_unfamiliar_input(const JudgedChange& judged);

}  // namespace softgrip::sysid
