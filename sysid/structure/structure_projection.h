#pragma once
// Computes the optimal weights of a structure for given nonlinear parameters by nonnegative least squares
// with ridge regularisation.

#include <Eigen/Core>

#include "model/characteristic_map.h"
#include "sysid/structure/structure_columns.h"

namespace softgrip::sysid {

/// Data, bounds and regularisation of a least-squares problem for the weights.
struct ProjectionProblem {
  const Eigen::MatrixXd& columns;
  const ColumnLayout& layout;
  const Eigen::VectorXd& readings_mm;
  double largest_kpa =
      1;  ///< largest pressure, which converts a weight to the largest motion of its operator [mm]
  double least_elastic =
      0;  ///< lower bound of the elastic weight; if it is positive, the model has an inverse
  /// Factor of the ridge penalty: the squares of weight * largest_kpa are added to the mean square error.
  double ridge = 0;
};

struct Projection {
  Eigen::VectorXd weights;
  Eigen::VectorXd error_mm;    ///< prediction minus reading, for all rows
  Eigen::VectorXd penalty_mm;  ///< the ridge penalty as additional residuals, in the scale of error_mm
  double mean_square_mm2 = 0;  ///< mean square error of all rows
};

/// Computes the optimal weights. If the characteristic is nonlinear, Gauss-Newton steps are made. They start
/// at `near` or, without it, at the solution for readings to which the inverse characteristic was applied.
/// @param near  weights of a similar problem with the same layout, or nullptr.
[[nodiscard]] Projection project(const ProjectionProblem& problem,
                                 const model::CharacteristicMap<double>& map,
                                 const Eigen::VectorXd* near = nullptr);

}  // namespace softgrip::sysid
