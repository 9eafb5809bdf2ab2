#pragma once
// Play operators without an immediate response to a reversal behave like operators followed by a backlash.
// Each can compensate for the other.

#include <optional>

#include "model/model.h"

namespace softgrip::sysid {

/// Returns the weighted share of the model's play operators that follow the pressure at once, 0 to 1. The
/// value is 1 if the model has no play operator.
[[nodiscard]] double elastic_share(const model::Model& model);

/// Returns a start point for a backlash search. Every operator follows earlier, by the threshold of the first
/// operator that is not elastic. A backlash follows the operators; its width is the motion of that operator
/// in the meantime. Returns an empty value if no such operator exists or the model already has a backlash.
[[nodiscard]] std::optional<model::Model> with_slack_as_backlash(const model::Model& model);

}  // namespace softgrip::sysid
