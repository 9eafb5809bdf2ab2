#pragma once
// Blocks behind everything that a base does: what they make of its readings follows from these sample by
// sample, and the base need not be walked again for it.

#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Whether `blocks`, joined to `base`, would stand behind all of its blocks and show at a sample what follows
/// from the base's reading at that sample alone, whatever the way to it was. Of a held command or an unknown
/// start: never.
[[nodiscard]] bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                                 const Record& record);

/// What predict() gives of the base with the blocks.
/// @param blocks  is_downstream(). @param base_mm  the base's own prediction of the record.
[[nodiscard]] std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks,
                                             const Record& record, std::vector<double> base_mm);

}  // namespace softgrip::sysid
