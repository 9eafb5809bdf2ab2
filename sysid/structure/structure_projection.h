#pragma once
// Computes the optimal weights of a structure for constant nonlinear parameters. The method is least squares
// with bounds and ridge regularisation.

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
      1;  ///< largest pressure; weight * largest_kpa is the largest motion of an operator [mm]
  double least_elastic =
      0;  ///< lower bound of the elastic weight; if the bound is positive, the model has an inverse
  /// Factor of the ridge penalty. The penalty is this factor times the sum of the squares of weight *
  /// largest_kpa, and is added to the mean square error.
  double ridge = 0;
};

struct Projection {
  Eigen::VectorXd weights;
  Eigen::VectorXd error_mm;    ///< prediction minus reading, for all rows
  Eigen::VectorXd penalty_mm;  ///< ridge penalty, stated as additional residuals in the unit of error_mm
  double mean_square_mm2 = 0;  ///< mean square error of all rows
};

/// Computes the optimal weights. If the characteristic is nonlinear, the weights are found by Gauss-Newton
/// steps. The steps start at `near`. If `near` is nullptr, they start at the weights of a linear problem, in
/// which the inverse characteristic is applied to the readings.
/// @param near  weights of a similar problem with the same layout, or nullptr.
[[nodiscard]] Projection project(const ProjectionProblem& problem,
                                 const model::CharacteristicMap<double>& map,
                                 const Eigen::VectorXd* near = nullptr);

}  // namespace softgrip::sysid
