#pragma once
// Converts play operators into a backlash. Play operators without an immediate response to a reversal behave
// like operators followed by a backlash, so each of the two can compensate for the other.

#include <optional>

#include "model/model.h"

namespace softgrip::sysid {

/// Returns the weighted share of the model's play operators that follow the pressure without a threshold,
/// from 0 to 1. The share is 1 if the model has no play operator.
[[nodiscard]] double elastic_share(const model::Model& model);

/// Returns a start point of a search for a backlash. All thresholds are reduced by that of the first operator
/// with a positive threshold, and a backlash is added behind the operators. The width of the backlash is the
/// motion of that operator over twice its threshold. Returns an empty value if no such operator exists or the
/// model already has a backlash.
[[nodiscard]] std::optional<model::Model> with_slack_as_backlash(const model::Model& model);

}  // namespace softgrip::sysid
