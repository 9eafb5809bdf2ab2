#pragma once
// Draws a model as a block diagram with its parameters.

#include "model/model.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Returns the block diagram of `model` from command to reading. Blocks that the model `given` does not
/// contain are marked.
[[nodiscard]] Figure chain_figure(const model::Model& model, const model::Model& given);

}  // namespace softgrip::sysid
