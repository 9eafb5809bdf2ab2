#pragma once
// A structure fitted to records: its few nonlinear numbers are searched, all weights follow (variable
// projection).

#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

struct StructureFitOptions {
  double ridge = 1e-5;           ///< see ProjectionProblem
  int most_iterations = 40;      ///< from each start
  std::size_t most_rows = 2500;  ///< readings that the search looks at; the weights are then fitted to all
};

/// A structure with numbers.
struct FittedStructure {
  BaseStructure structure;
  StructureGrid grid;
  NonlinearNumbers numbers;
  Eigen::VectorXd weights;  ///< by ColumnLayout
  double mean_square_mm2 = 0;
  double ridge = 0;
  bool converged = false;
  std::vector<double> start_rmse_mm;  ///< where the search from each start ended
};

/// Thresholds, time constants and hinges for these records. With few cycles of data there are fewer plays.
[[nodiscard]] StructureGrid grid_for(const std::vector<Record>& records);

/// The numbers with a regulator's in the place of the lag's, where a search for them may begin: overlap and
/// error of a fully open port by the pressures that there are.
[[nodiscard]] NonlinearNumbers with_usual_regulator(NonlinearNumbers numbers, const StructureGrid& grid);

/// From several starts of its own, or from `near`, where numbers are known already; a structure with a
/// regulator is fitted from `near` alone, see with_usual_regulator().
[[nodiscard]] FittedStructure fit_form(const std::vector<Record>& records, const BaseStructure& structure,
                                       const StructureGrid& grid, const StructureFitOptions& options,
                                       const NonlinearNumbers* near = nullptr);

/// The readings without what their zeros do besides what the finger does: the structure with wandering zeros
/// fitted, and those taken away.
[[nodiscard]] std::vector<Record> without_wandering(std::vector<Record> records, BaseStructure structure,
                                                    const StructureFitOptions& options);

}  // namespace softgrip::sysid
