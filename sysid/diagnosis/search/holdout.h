#pragma once
// Held-out losses of a structure by refits (linear_holdout.h computes them without refits).

#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/evidence/units.h"
#include "sysid/fitting/held_out.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Length of the blocks on which causes are compared [s]. Longer correlation times are rare.
inline constexpr double block_length_s = 8;

/// Returns the losses of the structure, refitted without each fold. The records keep their initial states in
/// `fit`.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const StructureFit& fit);
/// Returns the losses of the structure, refitted without each unit (sysid/evidence/units.h). The first
/// readings of a completely omitted log determine its initial state (sysid/fitting/start_estimate.h).
/// @param by_unit  divide_by_unit(records).
[[nodiscard]] BlockLosses left_out_losses(const std::vector<Record>& records, const Division& by_unit,
                                          const StructureFit& fit);
/// Returns the losses of a model without a refit.
[[nodiscard]] BlockLosses losses_of(const StructureFit& fit, const Division& division);

}  // namespace softgrip::sysid
