#include "sysid/fitting/descent.h"

#include <Eigen/Cholesky>

namespace softgrip::sysid {

Eigen::VectorXd damped_step(const NormalEquations& normal, const StepBounds& bounds, double damping,
                            const DescentOptions& options) {
  Eigen::MatrixXd damped = normal.curvature;
  Eigen::VectorXd downhill = -normal.gradient;
  const double all = normal.curvature.trace();
  for (Eigen::Index i = 0; i < downhill.size(); ++i) {
    const bool held = (bounds.lower(i) >= 0 && downhill(i) < 0) || (bounds.upper(i) <= 0 && downhill(i) > 0);
    if (held) {
      damped.row(i).setZero();
      damped.col(i).setZero();
      damped(i, i) = 1;
      downhill(i) = 0;
    } else {
      // The constant 1e-300 makes the system solvable even if the matrix is zero.
      damped(i, i) += damping * damped(i, i) + (damping * options.least_damping + 1e-12) * all + 1e-300;
    }
  }
  const Eigen::VectorXd step = damped.ldlt().solve(downhill);
  return step.cwiseMax(-options.longest_step)
      .cwiseMin(options.longest_step)
      .cwiseMax(bounds.lower)
      .cwiseMin(bounds.upper);
}

}  // namespace softgrip::sysid
