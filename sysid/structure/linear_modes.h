#pragma once
// Finds start points for the linear modes of a structure.

#include <vector>

#include "sysid/structure/structure.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// Start point of a structure with one more linear mode.
struct StartOfMode {
  double mean_square_mm2 = 0;  ///< mean square error at the start point
  NonlinearNumbers numbers;
};

/// Returns start points of a structure for its next linear mode, the best first. Each has one mode more than
/// `numbers`. The function scans periods, damping ratios and dead times. For each of them, linear least
/// squares gives the weights of all columns.
/// @param structure  structure with more modes than `numbers`.
[[nodiscard]] std::vector<StartOfMode> starts_of_next_mode(const std::vector<Record>& records,
                                                           BaseStructure structure, const StructureGrid& grid,
                                                           const NonlinearNumbers& numbers,
                                                           const StructureFitOptions& options);

}  // namespace softgrip::sysid
