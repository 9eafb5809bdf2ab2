#pragma once
// Computes held-out losses without a refit per block. It is intended for structures with many parameters.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {

/// Approximates held_out_losses(). The fit is assumed to respond linearly when readings are left out. For
/// each fold, one Gauss-Newton step starts at the fit to all readings. The step is damped in directions that
/// the data hardly determine.
/// @param fit  a fit at or near its optimum.
[[nodiscard]] BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                                 const StructureFit& fit);

}  // namespace softgrip::sysid
