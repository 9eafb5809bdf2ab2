#include "sysid/structure/structure_projection.h"

#include <limits>
#include <utility>

#include "base/thread_budget.h"
#include "sysid/fitting/bounded_solve.h"

namespace softgrip::sysid {
namespace {

constexpr int most_steps = 20;
constexpr double settled_share = 1e-8;
/// Factor of the ridge penalty for linear modes and for the elastic gain of a linear structure.
constexpr double least_ridge = 1e-9;

class Projector {
 public:
  Projector(const ProjectionProblem& problem, const model::CharacteristicMap<double>& map)
      : p_(problem), map_(map) {
    const Eigen::Index n = p_.columns.cols(), own = p_.layout.own();
    lower_ = Eigen::VectorXd::Zero(n);
    upper_ = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
    ridge_ = Eigen::VectorXd::Constant(n, p_.largest_kpa * p_.largest_kpa);
    for (Eigen::Index c = own; c < n; ++c) {
      lower_(c) = -std::numeric_limits<double>::infinity();
      ridge_(c) = 1;
    }
    for (std::size_t r = 0; r < p_.layout.records(); ++r) {
      if (p_.layout.offset(r) >= 0) ridge_(p_.layout.offset(r)) = 0;
    }
    fitted_ = std::max(1.0, static_cast<double>(p_.columns.rows()));
    ridge_ *= p_.ridge * fitted_;
    lower_(ColumnLayout::elastic()) = p_.least_elastic;
    for (std::size_t b = 0; b < p_.layout.branches(); ++b)
      lower_(p_.layout.creep(b)) = p_.layout.least_creep_mm_per_kpa(b);
    // A model with zeros near its poles requires large mode gains of opposite signs. The ridge penalty of the
    // mode gains is weak, so that it permits these gains. It excludes only gains that the readings do not
    // determine.
    const auto free_sign = [&](Eigen::Index first, Eigen::Index count) {
      lower_.segment(first, count).setConstant(-std::numeric_limits<double>::infinity());
      ridge_.segment(first, count).setConstant(least_ridge * p_.largest_kpa * p_.largest_kpa * fitted_);
    };
    free_sign(p_.layout.mode(0), own - p_.layout.mode(0));
    if (p_.layout.linear()) free_sign(ColumnLayout::elastic(), 1);
  }

  Projection run(const Eigen::VectorXd* near) {
    Candidate best;
    if (map_.curvature() == 0) {
      best = at(solve(p_.columns, p_.readings_mm));
    } else {
      best = at(near != nullptr && near->size() == p_.columns.cols() ? *near : first_guess());
      for (int i = 0; i < most_steps; ++i) {
        end_if_cancelled();
        Candidate trial = at(linearised(best.inner_mm));
        for (int halving = 0; halving < 6 && !(trial.cost <= best.cost); ++halving)
          trial = at((best.weights + trial.weights) / 2);
        if (!(trial.cost <= best.cost)) break;
        const bool settled = best.cost - trial.cost <= settled_share * best.cost;
        best = std::move(trial);
        if (settled) break;
      }
    }
    Projection result;
    result.penalty_mm = ridge_.cwiseSqrt().cwiseProduct(best.weights);
    result.mean_square_mm2 = best.error_mm.squaredNorm() / fitted_;
    result.error_mm = std::move(best.error_mm);
    result.weights = std::move(best.weights);
    return result;
  }

 private:
  [[nodiscard]] Eigen::Index own() const { return p_.layout.own(); }
  /// Weights, and the quantities that follow from them.
  struct Candidate {
    Eigen::VectorXd weights;
    Eigen::VectorXd inner_mm;  ///< input of the characteristic
    Eigen::VectorXd error_mm;  ///< prediction minus readings
    double cost = 0;           ///< sum of the squared errors and of the penalties
  };
  [[nodiscard]] Candidate at(Eigen::VectorXd weights) const {
    Candidate candidate;
    candidate.inner_mm = p_.columns.leftCols(own()) * weights.head(own());
    candidate.error_mm = candidate.inner_mm.unaryExpr([this](double z) { return map_.value(z); }) +
                         beside(weights) - p_.readings_mm;
    candidate.cost = candidate.error_mm.squaredNorm() + ridge_.dot(weights.cwiseAbs2());
    candidate.weights = std::move(weights);
    return candidate;
  }
  [[nodiscard]] Eigen::VectorXd beside(const Eigen::VectorXd& x) const {
    const Eigen::Index n = p_.columns.cols() - own();
    return p_.columns.rightCols(n) * x.tail(n);
  }
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) const {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
    gram.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
    gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
    gram.diagonal() += ridge_;
    return solve_bounded(gram, columns.transpose() * target, lower_, upper_).x;
  }
  /// Returns the weights after one Gauss-Newton step. In this step, the characteristic is linearised at its
  /// input `z`.
  [[nodiscard]] Eigen::VectorXd linearised(const Eigen::VectorXd& z) const {
    const Eigen::VectorXd slope = z.unaryExpr([this](double v) { return map_.slope(v); });
    const Eigen::VectorXd value = z.unaryExpr([this](double v) { return map_.value(v); });
    Eigen::MatrixXd columns = p_.columns;
    columns.leftCols(own()) = slope.asDiagonal() * p_.columns.leftCols(own());
    return solve(columns, p_.readings_mm - value + slope.cwiseProduct(z));
  }
  [[nodiscard]] Eigen::VectorXd first_guess() const {
    const Eigen::VectorXd flat = solve(p_.columns, p_.readings_mm);
    const Eigen::VectorXd motion = p_.readings_mm - beside(flat);
    return linearised(motion.unaryExpr([this](double y) { return map_.inverse(y); }));
  }

  const ProjectionProblem& p_;
  const model::CharacteristicMap<double>& map_;
  Eigen::VectorXd lower_, upper_, ridge_;
  double fitted_ = 1;
};

}  // namespace

Projection project(const ProjectionProblem& problem, const model::CharacteristicMap<double>& map,
                   const Eigen::VectorXd* near) {
  return Projector(problem, map).run(near);
}

}  // namespace softgrip::sysid
