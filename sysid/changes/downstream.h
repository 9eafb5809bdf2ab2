#pragma once
// Blocks after all blocks of a base. Their output follows from the output of the base at the samples, so the
// base is not simulated again.

#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if all `blocks` are behind those of `base` and their output at a sample depends on the base's
/// output at that sample alone. Always false for a held command or an unknown start.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// Returns the result of predict() for the base with the blocks.
/// @param blocks  is_downstream() is true. @param base_mm  prediction of the record by the base.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

}  // namespace softgrip::sysid
