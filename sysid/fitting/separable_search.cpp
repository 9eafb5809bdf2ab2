#include "sysid/fitting/separable_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "sysid/fitting/bounded_solve.h"
#include "sysid/fitting/descent.h"
#include "sysid/fitting/separable_free_parts.h"

namespace softgrip::sysid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Accumulates the Gram matrix of the columns from blocks of rows.
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

NormalEquations SeparableSearch::normal(const SeparablePoint& point, const Linear& linear) const {
  const auto n = static_cast<Index>(lower_.size());
  const auto m = static_cast<Index>(coordinates_.size());
  MatrixXd linear_gram = MatrixXd::Zero(n, n);
  MatrixXd cross = MatrixXd::Zero(n, m);
  NormalEquations normal{VectorXd::Zero(m), MatrixXd::Zero(m, m)};
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
  // Eliminates the free linear parameters. The curvature of the reduced problem is curvature - cross' G^-1
  // cross. G is the Gram matrix of the columns of the free linear parameters. `cross` contains the products
  // of these columns and the columns of the nonlinear parameters.
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

/// The search from one start point. The class has the functions that descend() calls.
struct SeparableSearch::Descending {
  struct Point {
    SeparablePoint point;
    VectorXd q;
    Linear linear;
  };

  const SeparableSearch& search;

  [[nodiscard]] Point at(SeparablePoint from, VectorXd q) const {
    Point point{search.moved(std::move(from), q), std::move(q), {}};
    point.linear = search.project(point.point);
    search.set_linear(point.point, point.linear.values);
    return point;
  }

  [[nodiscard]] static double loss(const Point& at) { return at.linear.cost; }
  [[nodiscard]] NormalEquations normal(const Point& at) const { return search.normal(at.point, at.linear); }
  [[nodiscard]] StepBounds bounds(const Point& at) const {
    StepBounds bounds{-at.q, -at.q};
    for (Index i = 0; i < at.q.size(); ++i) {
      bounds.lower(i) += search.coordinates_[static_cast<std::size_t>(i)].lower;
      bounds.upper(i) += search.coordinates_[static_cast<std::size_t>(i)].upper;
    }
    return bounds;
  }
  [[nodiscard]] Point moved(const Point& from, const VectorXd& step) const {
    return at(from.point, from.q + step);
  }
};

SearchResult SeparableSearch::run(const FitPoint& start, double damping) const {
  const SeparablePoint point = to_separable(shape_, start);
  const Descending problem{*this};
  // The steps are limited, because the derivatives describe the loss only near the current point. A rate may
  // change by a factor of at most e^2, and any other coordinate by at most twice its scale.
  const auto end = descend(
      problem, problem.at(point, coordinates_of(point)),
      {.most_steps = 60, .most_trials = 12, .damping = damping, .longest_step = 2, .least_share = 1e-7});
  SearchResult result{to_fit_point(start, end.point.point), 0, end.steps, end.converged};
  result.rmse_mm = std::sqrt(std::max(end.point.linear.cost, 0.0) / static_cast<double>(residual_count_));
  return result;
}

}  // namespace softgrip::sysid
