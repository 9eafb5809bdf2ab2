#pragma once
// Fits a structure to records by variable projection. The search changes only the nonlinear parameters. For
// each set of nonlinear parameters, the optimal weights are computed. The fitted structure is converted into
// a model that consists of blocks. The daemon and all predictions use models of this type.

#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

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

/// Returns the model and the estimated start states of the records. Operators with weight 0 are omitted.
/// Exception: a creep branch stays in the model if the unsettled creep of a record needs its time constant.
/// The projection then gives it a weight above 0 (ColumnLayout::least_creep_mm_per_kpa()).
/// @param drive  input of the model. With Drive::measured, the lag belongs to the finger and comes after the
/// pressure sensor.
[[nodiscard]] FitPoint point_of(const FittedStructure& fit, const std::vector<Record>& records, Drive drive);

/// Returns true if point_of() raises the weight of a creep branch, because the block cannot represent so
/// small a compliance. The error of the model then differs from the error of the fit.
[[nodiscard]] bool has_raised_creep(const FittedStructure& fit, const std::vector<Record>& records);

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
