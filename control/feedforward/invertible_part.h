#pragma once
// What of a model without an inverse has one.

#include <optional>
#include <string>
#include <vector>

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

struct InvertiblePart {
  model::Model model;
  std::vector<std::string> left_out;  ///< ids of the blocks that were taken out
};

/// The model without what keeps `full_model` from it: the blocks that have no inverse, and, where that is not
/// enough, of the others the one that is missed least over a slow way from 0 kPa to each end of the limits
/// and back, twice. Nothing where no such part is accepted, or the model is accepted as it is.
/// @param tick_s  > 0.
[[nodiscard]] std::optional<InvertiblePart> invertible_part(const model::Model& model,
                                                            const LimitSettings& limits, double tick_s);

}  // namespace softgrip::control
