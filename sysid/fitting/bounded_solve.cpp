#include "sysid/fitting/bounded_solve.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace softgrip::sysid {
namespace {

/// Regularisation that is added to the unit diagonal of the scaled matrix. With this addition, the minimum is
/// unique even if the matrix is singular.
constexpr double regularisation = 1e-13;

/// Finds the minimum by the primal active-set method, in scaled variables.
class ActiveSet {
 public:
  ActiveSet(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b, const Eigen::VectorXd& lower,
            const Eigen::VectorXd& upper)
      : gram_(gram),
        b_(b),
        lower_(lower),
        upper_(upper),
        x_(Eigen::VectorXd::Zero(b.size())),
        held_(static_cast<std::size_t>(b.size()), false) {
    x_ = x_.cwiseMax(lower_).cwiseMin(upper_);
  }

  void run() {
    const Eigen::Index most = 5 * b_.size() + 10;
    for (Eigen::Index i = 0; i < most; ++i) {
      if (!advance() && !release()) return;
    }
  }
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] const std::vector<bool>& held() const { return held_; }

 private:
  [[nodiscard]] bool held(Eigen::Index i) const { return held_[static_cast<std::size_t>(i)]; }

  /// Moves x towards the minimum over the free variables. Returns true if x reached a bound before it reached
  /// this minimum.
  bool advance() {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < b_.size(); ++i) {
      if (!held(i)) free.push_back(i);
    }
    if (free.empty()) return false;
    const Eigen::VectorXd gradient = b_ - gram_ * x_;
    const Eigen::MatrixXd g = kept(gram_, free);
    Eigen::VectorXd right(static_cast<Eigen::Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) right(static_cast<Eigen::Index>(i)) = gradient(free[i]);
    const Eigen::VectorXd step = g.ldlt().solve(right);
    double share = 1;
    Eigen::Index stopped = -1;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const Eigen::Index at = free[i];
      const double d = step(static_cast<Eigen::Index>(i));
      const double room = d < 0 ? lower_(at) - x_(at) : upper_(at) - x_(at);
      if (std::abs(d) > std::abs(room) && std::abs(room) < share * std::abs(d)) {
        share = std::abs(room) / std::abs(d);
        stopped = at;
      }
    }
    for (std::size_t i = 0; i < free.size(); ++i) x_(free[i]) += share * step(static_cast<Eigen::Index>(i));
    if (stopped < 0) return false;
    x_(stopped) = step_sign(stopped, free, step) < 0 ? lower_(stopped) : upper_(stopped);
    held_[static_cast<std::size_t>(stopped)] = true;
    return true;
  }
  static double step_sign(Eigen::Index at, const std::vector<Eigen::Index>& free,
                          const Eigen::VectorXd& step) {
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (free[i] == at) return step(static_cast<Eigen::Index>(i));
    }
    return 0;
  }

  /// Releases the active bound whose multiplier has the wrong sign and the largest magnitude. Returns false
  /// if there is no such bound.
  bool release() {
    const Eigen::VectorXd gradient = b_ - gram_ * x_;
    double most = 1e-12;
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < b_.size(); ++i) {
      if (!held(i)) continue;
      const double wish = x_(i) <= lower_(i) ? gradient(i) : -gradient(i);
      if (wish > most) {
        most = wish;
        best = i;
      }
    }
    if (best < 0) return false;
    held_[static_cast<std::size_t>(best)] = false;
    return true;
  }

  const Eigen::MatrixXd& gram_;
  const Eigen::VectorXd& b_;
  const Eigen::VectorXd& lower_;
  const Eigen::VectorXd& upper_;
  Eigen::VectorXd x_;
  std::vector<bool> held_;
};

}  // namespace

BoundedSolution solve_bounded(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::VectorXd scale =
      gram.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
  Eigen::MatrixXd g = scale.asDiagonal() * gram * scale.asDiagonal();
  g.diagonal().array() += regularisation;
  // The right-hand side is scaled to a maximum of 1, because multipliers are compared with 1e-12.
  const Eigen::VectorXd scaled_b = scale.cwiseProduct(b);
  const double size = std::max(scaled_b.cwiseAbs().maxCoeff(), 1e-300);
  const Eigen::VectorXd right = scaled_b / size;
  const Eigen::VectorXd low = lower.cwiseQuotient(scale) / size;
  const Eigen::VectorXd high = upper.cwiseQuotient(scale) / size;
  ActiveSet set(g, right, low, high);
  set.run();
  return {set.x().cwiseProduct(scale) * size, set.held()};
}

Eigen::MatrixXd kept(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& keep) {
  const auto n = static_cast<Eigen::Index>(keep.size());
  Eigen::MatrixXd part(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      part(i, j) = matrix(keep[static_cast<std::size_t>(i)], keep[static_cast<std::size_t>(j)]);
    }
  }
  return part;
}

}  // namespace softgrip::sysid
