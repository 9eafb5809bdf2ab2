#pragma once
// Solves small bounded least-squares problems that are given by their normal equations.

#include <vector>

#include <Eigen/Core>

namespace softgrip::sysid {

/// Solution of a bounded least-squares problem.
struct BoundedSolution {
  Eigen::VectorXd x;
  std::vector<bool> at_bound;  ///< true for each variable that is at a bound
};

/// Returns the point x at which x' G x / 2 - b' x has its minimum subject to lower <= x <= upper. G (`gram`)
/// is symmetric and positive semidefinite. G may be badly scaled or singular, because the solver scales G to
/// a unit diagonal and adds a small regularisation.
[[nodiscard]] BoundedSolution solve_bounded(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b,
                                            const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// Returns the submatrix of a symmetric matrix with the rows and columns in `keep`.
[[nodiscard]] Eigen::MatrixXd kept(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& keep);

}  // namespace softgrip::sysid
