#pragma once
// Finds start points for the linear modes of a structure, and detects linear dynamics that a structure lacks.

#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/division.h"
#include "sysid/structure/structure.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// Returns start points of a structure for its next linear mode, the best first. Each has one mode more than
/// `numbers`. The function scans periods, damping ratios and dead times. For each of them, linear least
/// squares gives the weights of all columns.
/// @param structure  structure with more modes than `numbers`.
[[nodiscard]] std::vector<NonlinearNumbers> starts_of_next_mode(const std::vector<Record>& records,
                                                                BaseStructure structure,
                                                                const StructureGrid& grid,
                                                                const NonlinearNumbers& numbers,
                                                                const StructureFitOptions& options);

/// Returns true if linear dynamics that the model lacks can reduce its error. The response of a fixed set of
/// linear modes to the drive is fitted to the residual of the model, and to the readings. The result is true
/// if one of these fits predicts held-out blocks significantly better than the model.
/// @param losses_mm2  held-out losses of the model on the blocks of `division`.
[[nodiscard]] bool lacks_linear_dynamics(const FitPoint& point, const std::vector<Record>& records,
                                         const StructureGrid& grid, const Division& division,
                                         const std::vector<double>& losses_mm2);

}  // namespace softgrip::sysid
