#pragma once
// Held-out evidence of a structure, by refits (linear_holdout.h: without them).

#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/evidence/units.h"
#include "sysid/fitting/held_out.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Of the blocks on which causes are judged: what resembles itself for longer is rare.
inline constexpr double block_length_s = 8;

/// The structure refitted without each fold. The starts of the records stay as they are in `fit`.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const StructureFit& fit);
/// The structure refitted without each unit (sysid/evidence/units.h). The first readings of a log
/// that is left out as a whole determine its start (sysid/fitting/start_estimate.h).
/// @param by_unit  divide_by_unit(records).
[[nodiscard]] BlockLosses left_out_losses(const std::vector<Record>& records, const Division& by_unit,
                                          const StructureFit& fit);
/// Of a model that is not refitted.
[[nodiscard]] BlockLosses losses_of(const StructureFit& fit, const Division& division);

}  // namespace softgrip::sysid
