#pragma once
// Defines the matrix type for the Jacobian of residuals.

#include <Eigen/Core>

namespace softgrip::sysid {

/// Jacobian of residuals: one row for each residual and one column for each coordinate, in the order in which
/// Residuals::evaluate() writes them.
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace softgrip::sysid
