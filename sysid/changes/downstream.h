#pragma once
// Simulates blocks that follow all blocks of a baseline model. The output of these blocks depends only on the
// sampled output of the baseline model, so the baseline model is not simulated again.

#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if two conditions hold. All `blocks` come after the blocks of `base` in the signal path. The
/// output of `blocks` at a sample depends only on the output of `base` at the samples. Returns false if the
/// command is held or if the initial state is unknown.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// Returns the result of predict() for the baseline model followed by the blocks. The baseline model is not
/// simulated.
/// @param blocks  blocks for which is_downstream() is true.
/// @param base_mm  prediction of the baseline model for the record.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

}  // namespace softgrip::sysid
