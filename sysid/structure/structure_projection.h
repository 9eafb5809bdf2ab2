#pragma once
// The best weights of a structure whose nonlinear numbers are given: nonnegative least squares with a ridge.

#include <Eigen/Core>

#include "model/characteristic_map.h"
#include "sysid/structure/structure_columns.h"

namespace softgrip::sysid {

/// What the weights are fitted to.
struct ProjectionProblem {
  const Eigen::MatrixXd& columns;
  const ColumnLayout& layout;
  const Eigen::VectorXd& readings_mm;
  const Eigen::VectorXd& row_weights;  ///< 1: fitted, 0: held out
  double largest_kpa = 1;              ///< a weight times it is what the operator can move the finger by
  double ridge = 0;                    ///< added to the mean square, per squared millimetre of that
};

struct Projection {
  Eigen::VectorXd weights;
  Eigen::VectorXd error_mm;    ///< prediction minus reading, of all rows
  Eigen::VectorXd penalty_mm;  ///< the ridge as further residuals, scaled like one row's
  double mean_square_mm2 = 0;  ///< of the fitted rows
};

/// With a bent characteristic by Gauss-Newton steps on the weights, from the readings seen backwards through
/// it.
[[nodiscard]] Projection project(const ProjectionProblem& problem,
                                 const model::CharacteristicMap<double>& map);

}  // namespace softgrip::sysid
