#pragma once
// Computes held-out losses without a refit per block, for a structure with many parameters.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {

/// Approximates held_out_losses() under the assumption that the parameters respond linearly when readings are
/// omitted. For each fold, one Gauss-Newton step is made from the fit to all readings. The step is damped in
/// directions that the data hardly determine.
/// @param fit  a fit at or near its optimum.
[[nodiscard]] BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                                 const StructureFit& fit);

}  // namespace softgrip::sysid
