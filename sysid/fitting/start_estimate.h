#pragma once
// The rule by which the start of a unit is estimated that was not fitted.
//
// A unit is a run, or a segment of one, that was left out of the fit. Its prediction may use the readings of
// the unit's first 5 % (at least 2 s, at most half of the unit) to estimate the state in which it begins and
// the sensor's offset, under priors. It uses no other reading. The drive of the whole unit is known: it is
// the input of the prediction.
//
// Priors. The offset may be anything: a shift of all readings shifts the estimate and changes no error. The
// pressure turned last within the range of the unit's drive. Creep that had not settled has a standard
// deviation of 0.3 of what that range makes of its branch.
//
// What is known (Record::start) decides what is estimated. Of a start at rest: the offset. Of an unknown
// start, and of one under pressure of which nothing is known: offset, hysteresis and creep. Otherwise the
// unit is taken for one that begins at rest, unless that leaves more than 3 standard deviations of the noise
// and of a model that errs by 5 % of the motion.
//
// One stroke does not show which of the starts under pressure it began with. Of those that the first readings
// do not tell apart, the one is taken whose hysteresis is in the cycle over the range of the drive.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// How long the beginning of a unit is [s]: 5 % of it, 2 s at least, and half of the unit at most.
[[nodiscard]] double begin_s(const Record& unit) noexcept;
/// The samples of the beginning, which the rule may use: [0, n). The first at least.
[[nodiscard]] std::size_t samples_for_start(const Record& record);

/// Where the unit begins. Without a finite reading among the first samples it begins at rest and without
/// offset.
[[nodiscard]] StartState estimated_start(const model::Model& model, const Record& unit);
/// The same for every unit by itself.
[[nodiscard]] std::vector<StartState> estimated_starts(const model::Model& model,
                                                       const std::vector<Record>& units);
/// Whether it is a start at rest: no turn of the pressure before the first sample, and no unsettled creep.
[[nodiscard]] bool is_at_rest(const StartState& start, const Record& unit);

}  // namespace softgrip::sysid
