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

/// Sets those residuals of a pressure to NaN that follow an unfamiliar command, up to the longest memory of
/// the baseline model. A command is unfamiliar if its distance from the predicted pressure exceeds the
/// largest distance in the healthy records by more than 25 %. For such a command, the healthy records do not
/// show how fast the air flows.
/// @param later  later records at the full sampling rate.
/// @param left_kpa  residuals, one list per later record.
/// @return share of the residuals that were set to NaN, 0 .. 1.
double remove_unfamiliar_commands(const Base& base, const std::vector<Record>& later,
                                  std::vector<std::vector<double>>& left_kpa);

/// Returns true if the input of the later logs is so unlike the healthy inputs that the answer states it. The
/// input increases the permitted mean square error by more than 10 %, or more than 10 % of the readings are
/// not evaluated.
[[nodiscard]] bool has_unfamiliar_input(const JudgedChange& judged);

}  // namespace softgrip::sysid
