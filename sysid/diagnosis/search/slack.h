#pragma once
// Converts part of the play operators of a model into a backlash. Consider play operators that do not respond
// at once to a reversal. They are equivalent to other play operators in series with a backlash. In a fit, the
// operators can therefore absorb a backlash.

#include <optional>

#include "model/model.h"

namespace softgrip::sysid {

/// Returns the share of the elastic play operators (threshold 0) in the sum of all weights, from 0 to 1.
/// Elastic operators follow the pressure at once. Returns 1 if the model has no play operators.
[[nodiscard]] double elastic_share(const model::Model& model);

/// Returns a start point for a fit with a backlash. The smallest positive threshold is subtracted from all
/// thresholds, and a backlash is added behind the operators. The width of the backlash is twice this
/// threshold times the weight of its operator. Returns nullopt if no threshold is positive or if the model
/// already contains a backlash.
[[nodiscard]] std::optional<model::Model> with_slack_as_backlash(const model::Model& model);

}  // namespace softgrip::sysid
