#pragma once
// Simulates blocks that follow all blocks of a baseline model. Their output depends only on the output of the
// baseline model at the samples, so this model is not simulated again.

#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if all `blocks` come after the blocks of `base` in the signal path, and if their output at a
/// sample depends only on the output of `base` at this sample. Returns false if the command is held or the
/// initial state is unknown.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// Returns the result of predict() for the baseline model followed by the blocks, without a simulation of the
/// baseline model.
/// @param blocks  blocks for which is_downstream() is true.
/// @param base_mm  prediction of the baseline model for the record.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

}  // namespace softgrip::sysid
