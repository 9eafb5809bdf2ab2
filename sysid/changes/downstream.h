#pragma once
// Simulates blocks that follow all blocks of a baseline model. Their output depends only on the output of the
// baseline model at the samples, so this model is not simulated again.

#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if all `blocks` follow those of `base` in the chain and their output at a sample depends only
/// on the output of `base` at this sample. Always false for a held command or an unknown initial state.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// Returns the same result as predict() for the baseline model with the blocks.
/// @param blocks  blocks for which is_downstream() is true.
/// @param base_mm  prediction of the baseline model for the record.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

}  // namespace softgrip::sysid
