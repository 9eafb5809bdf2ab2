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
  double largest_kpa = 1;    ///< a weight times it is what the operator can move the finger by
  double least_elastic = 0;  ///< of the elastic weight: above 0 every fitted model has an inverse
  double ridge = 0;          ///< added to the mean square, per squared millimetre of that
};

struct Projection {
  Eigen::VectorXd weights;
  Eigen::VectorXd error_mm;    ///< prediction minus reading, of all rows
  Eigen::VectorXd penalty_mm;  ///< the ridge as further residuals, scaled like one row's
  double mean_square_mm2 = 0;  ///< of all rows
};

/// @param near  weights of a neighbouring problem of the same layout, or nullptr. With a bent characteristic
/// by Gauss-Newton steps on the weights, from the readings seen backwards through it.
[[nodiscard]] Projection project(const ProjectionProblem& problem,
                                 const model::CharacteristicMap<double>& map,
                                 const Eigen::VectorXd* near = nullptr);

}  // namespace softgrip::sysid
