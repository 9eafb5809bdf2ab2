#pragma once
// Held-out evidence of a structure with many numbers, without refitting it block by block.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {

/// What held_out_losses() says, where the numbers' answer to missing readings is taken as linear: one
/// Gauss-Newton step from the fit to all readings, damped along directions that the data hardly show.
/// @param fit  at or near its optimum.
[[nodiscard]] BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                                 const StructureFit& fit);

}  // namespace softgrip::sysid
