#pragma once
// Estimate of the start state of a unit that was not fitted.
//
// A unit is a run, or a segment of a run, that was left out of the fit. The readings of its first 5 % (at
// least 2 s, at most half of the unit) may be used to estimate its start state and the sensor's offset, under
// priors. No other reading is used. The drive of the whole unit is known, because it is the input of the
// prediction.
//
// Priors: The offset has no prior, so a shift of all readings shifts the estimate and changes no error. The
// last reversals of the pressure were within the range of the unit's drive. Unsettled creep of a branch has a
// standard deviation of 0.3 times the branch's settled creep over that range.
//
// Record::start decides what is estimated. For a start at rest, only the offset is estimated. For an unknown
// start, offset, hysteresis and creep are estimated. Otherwise the unit is assumed to begin at rest, unless
// the residual of that start is significant: 3 standard deviations of the noise and of a model error of 5 %
// of the motion.
//
// One stroke does not determine the start state under pressure. If the first readings do not distinguish the
// candidates, the start is used whose hysteresis is in the steady cycle over the range of the drive.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the duration of a unit's beginning [s]: 5 % of the unit, at least 2 s, and at most half of the
/// unit.
[[nodiscard]] double begin_s(const Record& unit) noexcept;
/// Returns the number n >= 1 of samples in the beginning. The estimate uses only the samples [0, n).
[[nodiscard]] std::size_t samples_for_start(const Record& record);

/// Returns the estimated start state of a unit. If the beginning has no finite reading, the unit begins at
/// rest with zero offset.
[[nodiscard]] StartState estimated_start(const model::Model& model, const Record& unit);
/// Returns estimated_start() for each unit.
[[nodiscard]] std::vector<StartState> estimated_starts(const model::Model& model,
                                                       const std::vector<Record>& units);
/// Returns true for a start at rest: no reversal of the pressure before the first sample, and no unsettled
/// creep.
[[nodiscard]] bool is_at_rest(const StartState& start, const Record& unit);

}  // namespace softgrip::sysid
