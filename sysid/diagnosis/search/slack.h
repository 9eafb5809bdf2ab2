#pragma once
// Play operators of which none follows a reversal at once stand still first, as a backlash behind them does:
// either makes up for the other.

#include <optional>

#include "model/model.h"

namespace softgrip::sysid {

/// What share of the weight of the model's play operators follows the pressure at once, 0 to 1; 1 where it
/// has none.
[[nodiscard]] double elastic_share(const model::Model& model);

/// Where a search for a backlash may begin: every operator follows sooner, by the threshold of the first that
/// is not elastic, and a backlash as wide as what that one moves meanwhile stands behind them. Nothing where
/// there is no such operator, or a backlash already.
[[nodiscard]] std::optional<model::Model> with_slack_as_backlash(const model::Model& model);

}  // namespace softgrip::sysid
