#pragma once
// Optimal weights of a structure with given nonlinear parameters: nonnegative least squares with ridge
// regularisation.

#include <Eigen/Core>

#include "model/characteristic_map.h"
#include "sysid/structure/structure_columns.h"

namespace softgrip::sysid {

/// The data, bounds and regularisation of the least-squares problem.
struct ProjectionProblem {
  const Eigen::MatrixXd& columns;
  const ColumnLayout& layout;
  const Eigen::VectorXd& readings_mm;
  double largest_kpa =
      1;  ///< largest pressure; weight * largest_kpa is the largest motion of an operator [mm]
  double least_elastic =
      0;             ///< lower bound of the elastic weight; if it is above 0, the model has an inverse
  double ridge = 0;  ///< penalty on the square of weight * largest_kpa, added to the mean square error
};

struct Projection {
  Eigen::VectorXd weights;
  Eigen::VectorXd error_mm;    ///< prediction minus reading, for all rows
  Eigen::VectorXd penalty_mm;  ///< the ridge penalty as additional residuals, scaled like those of a row
  double mean_square_mm2 = 0;  ///< mean square error of all rows
};

/// Computes the optimal weights. With a nonlinear characteristic, Gauss-Newton steps are used. They begin at
/// `near`, or at the solution for the readings after the inverse characteristic.
/// @param near  weights of a similar problem with the same layout, or nullptr.
[[nodiscard]] Projection project(const ProjectionProblem& problem,
                                 const model::CharacteristicMap<double>& map,
                                 const Eigen::VectorXd* near = nullptr);

}  // namespace softgrip::sysid
