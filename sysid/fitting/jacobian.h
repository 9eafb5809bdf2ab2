#pragma once
// Matrix type for the Jacobian of residuals.

#include <Eigen/Core>

namespace softgrip::sysid {

/// One row for each residual and one column for each coordinate, as Residuals::evaluate() writes them.
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace softgrip::sysid
