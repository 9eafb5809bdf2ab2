#pragma once
// Converts part of the play operators of a model into a backlash. Play operators without an immediate
// response to a reversal behave like different play operators in series with a backlash. In a fit, operators
// and backlash can therefore compensate for each other.

#include <optional>

#include "model/model.h"

namespace softgrip::sysid {

/// Returns the weighted share of play operators with threshold 0, which follow the pressure at once, from 0
/// to 1. The share is 1 if the model has no play operators.
[[nodiscard]] double elastic_share(const model::Model& model);

/// Returns a start point of a search for a backlash. The threshold of the first operator with a positive
/// threshold is subtracted from all thresholds, and a backlash is added behind the operators. The width of
/// the backlash is the motion of this operator over twice its threshold. Returns nullopt if no such operator
/// exists or if the model contains a backlash.
[[nodiscard]] std::optional<model::Model> with_slack_as_backlash(const model::Model& model);

}  // namespace softgrip::sysid
