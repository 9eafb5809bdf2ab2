#include "sysid/fitting/separable_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "base/cancellation.h"
#include "sysid/fitting/bounded_solve.h"
#include "sysid/fitting/separable_free_parts.h"

namespace softgrip::sysid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sums up the Gram matrix of the columns that pass by.
class GramSink final : public SeparableRecord::Sink {
 public:
  explicit GramSink(Index columns) : gram_(MatrixXd::Zero(columns, columns)) {}

  void block(const Eigen::Ref<const MatrixXd>& rows) override {
    gram_.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  }
  [[nodiscard]] MatrixXd gram() const { return gram_.selfadjointView<Eigen::Lower>(); }

 private:
  MatrixXd gram_;
};

}  // namespace

std::optional<SeparableSearch> SeparableSearch::make(const std::vector<Record>& records,
                                                     const FitSpace& space) {
  const model::Model model = space.point(std::vector<double>(space.size(), 0.0)).model;
  const auto shape = separable_shape(model);
  if (!shape) return std::nullopt;
  const FreeParts parts(space, *shape, model);
  if (!parts.searchable()) return std::nullopt;
  return SeparableSearch(records, space, *shape, parts);
}

SeparableSearch::SeparableSearch(const std::vector<Record>& records, const FitSpace& space,
                                 const SeparableShape& shape, const FreeParts& parts)
    : space_(std::make_shared<const FitSpace>(space)), shape_(shape), alpha_free_(parts.alpha >= 0) {
  for (const Record& record : records) {
    records_.emplace_back(record, shape);
    residual_count_ += record.readings;
  }
  add_coordinates(parts);
  add_linear(parts);
}

SeparableSearch::Linear SeparableSearch::project(const SeparablePoint& point) const {
  const auto n = static_cast<Index>(lower_.size());
  MatrixXd gram = MatrixXd::Zero(n, n);
  VectorXd right = VectorXd::Zero(n);
  double squares = 0;
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const Index columns = records_[k].columns().linear();
    GramSink sink(columns + 1);
    records_[k].linear(point, k, sink);
    const MatrixXd local = sink.gram();
    const std::vector<Index> place = places(k);
    for (Index i = 0; i < columns; ++i) {
      const Index gi = place[static_cast<std::size_t>(i)];
      if (gi < 0) continue;
      right(gi) += local(i, columns);
      for (Index j = 0; j < columns; ++j) {
        if (const Index gj = place[static_cast<std::size_t>(j)]; gj >= 0) gram(gi, gj) += local(i, j);
      }
    }
    squares += local(columns, columns);
  }
  const BoundedSolution solution = solve_bounded(gram, right, Eigen::Map<const VectorXd>(lower_.data(), n),
                                                 Eigen::Map<const VectorXd>(upper_.data(), n));
  const double cost = squares - 2 * right.dot(solution.x) + solution.x.dot(gram * solution.x);
  return {solution.x, solution.at_bound, cost};
}

SeparableSearch::Normal SeparableSearch::normal(const SeparablePoint& point, const Linear& linear) const {
  const auto n = static_cast<Index>(lower_.size());
  const auto m = static_cast<Index>(coordinates_.size());
  MatrixXd linear_gram = MatrixXd::Zero(n, n);
  MatrixXd cross = MatrixXd::Zero(n, m);
  Normal normal{VectorXd::Zero(m), MatrixXd::Zero(m, m)};
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const SeparableColumns& c = records_[k].columns();
    GramSink sink(c.all() + 1);
    records_[k].full(point, k, sink);
    const MatrixXd local = sink.gram();
    const MatrixXd map = coordinate_map(point, k);
    const MatrixXd mapped = local.topLeftCorner(c.all(), c.all()) * map;
    normal.curvature += map.transpose() * mapped;
    normal.gradient += map.transpose() * local.topRightCorner(c.all(), 1);
    const std::vector<Index> place = places(k);
    for (Index i = 0; i < c.linear(); ++i) {
      const Index gi = place[static_cast<std::size_t>(i)];
      if (gi < 0) continue;
      cross.row(gi) += mapped.row(i);
      for (Index j = 0; j < c.linear(); ++j) {
        if (const Index gj = place[static_cast<std::size_t>(j)]; gj >= 0) linear_gram(gi, gj) += local(i, j);
      }
    }
  }
  // What the free linear parameters take over: curvature - cross' G^-1 cross.
  std::vector<Index> free;
  for (Index i = 0; i < n; ++i) {
    if (!linear.at_bound[static_cast<std::size_t>(i)]) free.push_back(i);
  }
  MatrixXd gram = kept(linear_gram, free);
  MatrixXd own(static_cast<Index>(free.size()), m);
  for (std::size_t i = 0; i < free.size(); ++i) own.row(static_cast<Index>(i)) = cross.row(free[i]);
  const VectorXd scale = gram.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
  gram = scale.asDiagonal() * gram * scale.asDiagonal();
  gram.diagonal().array() += 1e-12;
  own = scale.asDiagonal() * own;
  normal.curvature -= own.transpose() * gram.ldlt().solve(own);
  return normal;
}

SearchResult SeparableSearch::run(const FitPoint& start, int most_iterations, double damping) const {
  SeparablePoint point = to_separable(shape_, start);
  VectorXd q = coordinates_of(point);
  point = moved(std::move(point), q);
  Linear linear = project(point);
  set_linear(point, linear.values);
  SearchResult result;
  Normal normal = this->normal(point, linear);
  const auto low = [&](Index i) { return coordinates_[static_cast<std::size_t>(i)].lower; };
  const auto high = [&](Index i) { return coordinates_[static_cast<std::size_t>(i)].upper; };
  while (result.iterations < most_iterations && !result.converged) {
    end_if_cancelled();
    ++result.iterations;
    MatrixXd damped = normal.curvature;
    VectorXd downhill = -normal.gradient;
    for (Index i = 0; i < q.size(); ++i) {
      // Held where it is: at a bound that the gradient pushes against.
      const bool held = (q(i) <= low(i) && downhill(i) < 0) || (q(i) >= high(i) && downhill(i) > 0);
      if (held) {
        damped.row(i).setZero();
        damped.col(i).setZero();
        downhill(i) = 0;
        damped(i, i) = 1;
      } else {
        damped(i, i) += damping * damped(i, i) + 1e-12 * normal.curvature.trace() + 1e-300;
      }
    }
    VectorXd step = damped.ldlt().solve(downhill);
    // More than a factor e^2 in a rate, or twice the whole range, is beyond what the slope can know.
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > 2) step *= 2 / longest;
    VectorXd trial = q + step;
    for (Index i = 0; i < q.size(); ++i) trial(i) = std::clamp(trial(i), low(i), high(i));
    SeparablePoint trial_point = moved(point, trial);
    Linear trial_linear = project(trial_point);
    if (std::isfinite(trial_linear.cost) && trial_linear.cost < linear.cost) {
      const double gained = (linear.cost - trial_linear.cost) / linear.cost;
      set_linear(trial_point, trial_linear.values);
      q = trial;
      point = std::move(trial_point);
      linear = std::move(trial_linear);
      damping = std::max(damping / 8, 1e-12);
      result.converged = gained < 1e-7;
      if (!result.converged) normal = this->normal(point, linear);
    } else {
      damping *= 6;
      result.converged = damping > 1e6 || step.cwiseAbs().maxCoeff() < 1e-9;
    }
  }
  result.point = to_fit_point(start, point);
  result.rmse_mm = std::sqrt(std::max(linear.cost, 0.0) / static_cast<double>(residual_count_));
  return result;
}

}  // namespace softgrip::sysid
