#pragma once
// Computes held-out losses of a structure with many parameters without a refit per block.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {

/// Computes held_out_losses() under the assumption that the parameters respond linearly to missing readings.
/// It makes one Gauss-Newton step from the fit to all readings. The step is damped along directions that the
/// data hardly determine.
/// @param fit  at or near its optimum.
[[nodiscard]] BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                                 const StructureFit& fit);

}  // namespace softgrip::sysid
