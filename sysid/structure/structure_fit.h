#pragma once
// Fits a structure to records by variable projection: the few nonlinear numbers are searched, and all weights
// follow from them.

#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

struct StructureFitOptions {
  double ridge = 1e-5;           ///< see ProjectionProblem
  int most_iterations = 40;      ///< from each start
  std::size_t most_rows = 2500;  ///< readings of the search; the weights are then fitted to all
};

/// A structure with its numbers.
struct FittedStructure {
  BaseStructure structure;
  StructureGrid grid;
  NonlinearNumbers numbers;
  Eigen::VectorXd weights;  ///< by ColumnLayout
  double mean_square_mm2 = 0;
  double ridge = 0;
  bool converged = false;
  std::vector<double> start_rmse_mm;  ///< by start: the error at the end of the search
};

/// Returns thresholds, time constants and hinges for these records. Few cycles of data give fewer play
/// operators.
[[nodiscard]] StructureGrid grid_for(const std::vector<Record>& records);

/// Returns a start for the search of a regulator, in which the numbers of the lag are replaced. Its overlap
/// and its error with a fully open port are shares of the largest pressure.
[[nodiscard]] NonlinearNumbers with_usual_regulator(NonlinearNumbers numbers, const StructureGrid& grid);

/// Fits from several starts of its own, or from `near` if numbers are known. A structure with a regulator
/// needs `near`, see with_usual_regulator().
[[nodiscard]] FittedStructure fit_form(const std::vector<Record>& records, const BaseStructure& structure,
                                       const StructureGrid& grid, const StructureFitOptions& options,
                                       const NonlinearNumbers* near = nullptr);

/// Removes the drift of the zero from the readings: fits the structure with a drifting zero for each record
/// and subtracts the fitted zeros.
[[nodiscard]] std::vector<Record> without_wandering(std::vector<Record> records, BaseStructure structure,
                                                    const StructureFitOptions& options);

}  // namespace softgrip::sysid
