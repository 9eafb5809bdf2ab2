#pragma once
// Fits a structure to records by variable projection. The search changes only the nonlinear parameters. For
// each set of nonlinear parameters, the optimal weights are computed.

#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"
#include "sysid/structure/structure_grid.h"

namespace softgrip::sysid {

struct StructureFitOptions {
  double ridge = 1e-5;       ///< factor of the ridge penalty (ProjectionProblem::ridge)
  int most_iterations = 40;  ///< maximum number of iterations from each start point
  /// Maximum number of readings in the search; the final weights are fitted to all readings.
  std::size_t most_rows = 2500;
};

/// A structure with its fitted parameters.
struct FittedStructure {
  BaseStructure structure;
  StructureGrid grid;
  NonlinearNumbers numbers;
  Eigen::VectorXd weights;  ///< weights of the columns, in the order of ColumnLayout
  double mean_square_mm2 = 0;
  double ridge = 0;
  bool converged = false;
  std::vector<double> start_rmse_mm;  ///< for each start point, the RMSE at the end of the search
};

/// Returns start parameters for the fit of a regulator. They replace the parameters of a fitted lag. The
/// overlap, and the pressure error at which the port is fully open, are proportional to the largest pressure.
[[nodiscard]] NonlinearNumbers with_usual_regulator(NonlinearNumbers numbers, const StructureGrid& grid);

/// Fits a structure from several default start points, or from the parameters `near` if they are given. A
/// structure with a regulator requires `near`; see with_usual_regulator(). If the structure has more linear
/// modes than the start points, the start values of the next mode are searched; see starts_of_next_mode().
[[nodiscard]] FittedStructure fit_form(const std::vector<Record>& records, const BaseStructure& structure,
                                       const StructureGrid& grid, const StructureFitOptions& options,
                                       const NonlinearNumbers* near = nullptr);

/// Removes the drift of the zero offset from the readings. The structure is fitted together with one drift
/// per record, and the fitted drift is subtracted.
[[nodiscard]] std::vector<Record> without_zero_drift(std::vector<Record> records, BaseStructure structure,
                                                     const StructureFitOptions& options);

}  // namespace softgrip::sysid
