#pragma once
// Small least squares problems with bounds, given by their normal equations.

#include <vector>

#include <Eigen/Core>

namespace softgrip::sysid {

/// Minimises x' G x / 2 - b' x with lower <= x <= upper.
struct BoundedSolution {
  Eigen::VectorXd x;
  std::vector<bool> at_bound;  ///< held there by its multiplier
};

/// @param gram  symmetric, positive semidefinite, may be badly scaled or singular: it is scaled by its
///              diagonal and a hair is added to it.
[[nodiscard]] BoundedSolution solve_bounded(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b,
                                            const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// Rows and columns of a symmetric matrix for which keep holds.
[[nodiscard]] Eigen::MatrixXd kept(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& keep);

}  // namespace softgrip::sysid
