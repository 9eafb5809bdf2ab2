#pragma once
// Computes held-out losses of a structure, with refits, or for structures with many parameters without a
// refit per block.

#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/evidence/units.h"
#include "sysid/fitting/held_out.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Length of the blocks in which the losses of causes are compared [s]. The correlation time of a residual is
/// rarely longer.
inline constexpr double block_length_s = 8;

/// Returns the loss of each block. For each block, the structure is refitted to all folds except the fold of
/// this block. The initial states of the records are those in `fit`.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const StructureFit& fit);
/// Returns the loss of each unit (sysid/evidence/units.h). For each unit, the structure is refitted to the
/// other units. If a log is left out completely, its first readings determine its initial state
/// (sysid/fitting/start_estimate.h).
/// @param by_unit  result of divide_by_unit(records).
[[nodiscard]] BlockLosses left_out_losses(const std::vector<Record>& records, const Division& by_unit,
                                          const StructureFit& fit);
/// Returns the loss of a fitted structure on each block. The structure is not refitted.
[[nodiscard]] BlockLosses losses_of(const StructureFit& fit, const Division& division);

/// Approximates held_out_losses(). The fit is assumed to respond linearly when readings are left out. For
/// each fold, one Gauss-Newton step starts at the fit to all readings. The step is damped in directions that
/// the data hardly determine.
/// @param fit  a fit at or near its optimum.
[[nodiscard]] BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                                 const StructureFit& fit);

}  // namespace softgrip::sysid
