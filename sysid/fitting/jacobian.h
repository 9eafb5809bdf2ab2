#pragma once
// The Jacobian of residuals as a matrix.

#include <Eigen/Core>

namespace softgrip::sysid {

/// A residual a row, a coordinate a column, as Residuals::evaluate() writes them.
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace softgrip::sysid
