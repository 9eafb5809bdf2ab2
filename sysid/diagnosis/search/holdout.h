#pragma once
// Computes held-out losses of a structure. Either the structure is refitted for each fold, or the losses are
// approximated without refits, for structures with many parameters.

#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/evidence/units.h"
#include "sysid/fitting/held_out.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Length of the blocks in which the losses of causes are compared, in units of time_unit_s(). Correlation
/// times of residuals are rarely longer than this length.
inline constexpr double block_length_in_units = 8;

/// Returns the loss of each block. The structure is refitted to the readings outside the fold of the block.
/// The initial states of the records are taken from `fit`.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const StructureFit& fit);
/// Returns the loss of each cross-validation unit (sysid/evidence/units.h). For each loss, the structure is
/// refitted to the other units. If a unit is a complete log, its initial state is estimated from its first
/// readings (sysid/fitting/start_estimate.h).
/// @param by_unit  result of divide_by_unit(records).
[[nodiscard]] BlockLosses left_out_losses(const std::vector<Record>& records, const Division& by_unit,
                                          const StructureFit& fit);
/// Returns the loss of a fitted structure on each block. There is no refit, so the blocks are not held out.
[[nodiscard]] BlockLosses losses_of(const StructureFit& fit, const Division& division);

/// Approximates held_out_losses(). The function assumes that the fit responds linearly if readings are left
/// out. For each fold, it makes one Gauss-Newton step from the fit to all readings. The step is damped in
/// directions that the data hardly determine.
/// @param fit  fit at or near its optimum.
[[nodiscard]] BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                                 const StructureFit& fit);

}  // namespace softgrip::sysid
