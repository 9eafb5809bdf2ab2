#pragma once
// Finds the part of a model that can be inverted, if the whole model has no inverse.

#include <optional>
#include <string>
#include <vector>

#include "control/elements/limits.h"
#include "model/model.h"

namespace softgrip::control {

struct InvertiblePart {
  model::Model model;
  std::vector<std::string> left_out;  ///< ids of the blocks that were removed from the model
};

/// Returns the model without the blocks that prevent `full_model`. First, the blocks without an inverse are
/// removed. If `full_model` is still impossible, one more block is removed: the block with the smallest
/// effect among those whose removal makes `full_model` possible. The effect of a block is measured on a slow
/// path from 0 kPa to each end of the pressure range and back, twice. Returns an empty value if `full_model`
/// is possible for the unchanged model, or impossible after every removal.
[[nodiscard]] std::optional<InvertiblePart> invertible_part(const model::Model& model,
                                                            const LimitSettings& limits, double tick_s);

}  // namespace softgrip::control
