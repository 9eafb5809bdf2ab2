#include "sysid/fitting/descent.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace softgrip::sysid {
namespace {

constexpr double fixed_factor = 6;
constexpr double weakest_damping = 1e-10;

}  // namespace

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

void Damping::fail() {
  if (rule_ == DampingRule::fixed_factor) {
    now_ *= fixed_factor;
    return;
  }
  now_ *= more_;
  more_ *= 2;
}

void Damping::succeed(const NormalEquations& normal, const Eigen::VectorXd& step, double gain) {
  double factor = 1 / fixed_factor;
  if (rule_ == DampingRule::gain_ratio) {
    // `normal` belongs to half the loss.
    const double predicted = -2 * normal.gradient.dot(step) - step.dot(normal.curvature * step);
    const double excess = predicted > 0 ? 2 * gain / predicted - 1 : 0;
    factor = std::max(1.0 / 3, 1 - excess * excess * excess);
  }
  now_ = std::max(now_ * factor, weakest_damping);
  more_ = 2;
}

}  // namespace softgrip::sysid
