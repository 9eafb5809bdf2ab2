#pragma once
// Estimates the start state of a unit that was left out of the fit.
//
// A unit is a run, or a segment of a run. The start state of the unit and the offset of the sensor are
// estimated from the readings of the first 5 % of the unit (at least 2 s, at most half of the unit), with
// priors. No other reading is used. The drive of the whole unit is known, because it is the input of the
// prediction.
//
// The estimate uses the following priors. The offset has no prior, so that a shift of all readings changes
// the estimated offset, but not the errors of the prediction. The last reversals of the pressure are assumed
// within the range of the unit's drive. The unsettled creep of a branch has a standard deviation of 0.3 times
// the settled creep of the branch over that range.
//
// Record::start determines which quantities are estimated. For a start at rest, this is only the offset. For
// an unknown start, these quantities are offset, hysteresis and creep. In the automatic mode, a unit with
// Record::start_unknown has an unknown start. Any other unit is assumed to begin at rest, unless an unknown
// start reduces the mean square residual by more than the sum of two limits. The first is the reduction that
// noise causes with a probability of 0.1 %; it increases with the number of fitted numbers. The second is 9
// times the mean square of a model error of 5 % of the motion.
//
// An oscillation of the model, for example of a pump, begins each unit with another phase. The shift of the
// oscillations is estimated if it reduces the residual by more than 3 standard deviations of the noise.
//
// A single stroke does not determine the start state under pressure. If the first readings do not distinguish
// between possible start states, the hysteresis is assumed to be in its steady cycle over the range of the
// drive.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns the duration of the beginning of a unit [s]: 5 % of the unit, at least 2 s, and at most half of
/// the unit.
[[nodiscard]] double begin_s(const Record& unit) noexcept;
/// Returns the number n >= 1 of samples in the beginning. The estimate uses only the samples 0 to n - 1.
[[nodiscard]] std::size_t samples_for_start(const Record& record);

/// Returns the estimated start state of a unit. If the beginning has no finite reading, the result is a start
/// at rest with zero offset.
[[nodiscard]] StartState estimated_start(const model::Model& model, const Record& unit);
/// Returns estimated_start() of each unit.
[[nodiscard]] std::vector<StartState> estimated_starts(const model::Model& model,
                                                       const std::vector<Record>& units);
/// Returns true if the state is at rest: the pressure has no reversal before the first sample, and the creep
/// of all branches is settled.
[[nodiscard]] bool is_at_rest(const StartState& start, const Record& unit);

}  // namespace softgrip::sysid
