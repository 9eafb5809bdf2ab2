#pragma once
// Blocks behind everything that a base does: what they make of its readings follows from these sample by
// sample, and the base need not be walked again for it.

#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns true if all `blocks` are behind those of `base` and their output at a sample depends on the base's
/// output at that sample alone. Always false for a held command or an unknown start.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// Result of predict() for the base with the blocks.
/// @param blocks  is_downstream(). @param base_mm  the base's own prediction of the record.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

}  // namespace softgrip::sysid
