#include "sysid/separable_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "sysid/bounded_solve.h"

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

/// Which of a separable chain's parameters are free, by their index in the space; -1: fixed.
struct SeparableSearch::FreeParts {
  int alpha = -1, k0 = -1, beta = -1, gamma = -1, eta = -1, delay = -1, lag = -1;
  std::vector<int> stiffness, damping;

  FreeParts(const FitSpace& space, const SeparableShape& shape, const model::Model& model)
      : stiffness(shape.branches, -1), damping(shape.branches, -1) {
    for (std::size_t i = 0; i < space.size(); ++i) {
      const FreeParameter& p = space.free()[i];
      if (p.kind != FreeParameter::Kind::model) continue;
      const model::ParameterPlace place = model::place_of(model, p.flat_index);
      const int index = static_cast<int>(i);
      if (shape.delay && place.block == *shape.delay) delay = index;
      if (shape.lag && place.block == *shape.lag) lag = index;
      if (place.block == shape.bouc_wen) {
        for (const auto& [value, slot] :
             {std::pair<std::size_t, int*>{0, &alpha}, {1, &beta}, {2, &gamma}, {3, &eta}}) {
          if (place.value == value) *slot = index;
        }
      }
      if (place.block != shape.kelvin_voigt) continue;
      if (place.value == 0) {
        k0 = index;
      } else {
        ((place.value - 1) % 2 == 0 ? stiffness : damping)[(place.value - 1) / 2] = index;
      }
    }
  }

  [[nodiscard]] bool searchable() const {
    const auto is_free = [](int index) { return index >= 0; };
    return (is_free(alpha) || is_free(k0)) && is_free(beta) && is_free(gamma) == is_free(eta) &&
           std::all_of(stiffness.begin(), stiffness.end(), is_free) &&
           std::all_of(damping.begin(), damping.end(), is_free);
  }
};

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

void SeparableSearch::add_coordinates(const FreeParts& parts) {
  const auto& free = space_->free();
  double largest_kpa = 0;
  double longest_s = 0;
  double shortest_s = 1e9;
  for (const SeparableRecord& r : records_) {
    const Record& record = r.record();
    largest_kpa = std::max(largest_kpa, record.largest_kpa);
    longest_s = std::max(longest_s, record.time_s.back() - record.time_s.front());
    shortest_s = std::min(
        shortest_s, (record.time_s.back() - record.time_s.front()) / static_cast<double>(record.size()));
  }
  const auto at = [&](int index) -> const FreeParameter& { return free[static_cast<std::size_t>(index)]; };
  if (parts.gamma >= 0) {
    const double scale = 1 / largest_kpa;
    const FreeParameter& gamma = at(parts.gamma);
    const FreeParameter& eta = at(parts.eta);
    coordinates_.push_back({Coordinate::Kind::growing, 0, scale, 1e-6, (gamma.upper + eta.upper) / scale});
    coordinates_.push_back({Coordinate::Kind::eta, 0, scale, eta.lower / scale, eta.upper / scale});
  }
  for (std::size_t b = 0; b < shape_.branches; ++b) {
    const FreeParameter& k = at(parts.stiffness[b]);
    const FreeParameter& c = at(parts.damping[b]);
    // Slower than twenty logs is a dashpot, faster than half a sample is part of the spring.
    coordinates_.push_back({Coordinate::Kind::rate, b, 1,
                            std::log(std::max(k.lower / c.upper, 0.05 / longest_s)),
                            std::log(std::min(k.upper / c.lower, 2 / shortest_s))});
  }
  for (const auto& [kind, index] :
       {std::pair{Coordinate::Kind::delay, parts.delay}, {Coordinate::Kind::lag, parts.lag}}) {
    if (index >= 0)
      coordinates_.push_back({kind, 0, at(index).scale, at(index).lower_z(), at(index).upper_z()});
  }
  for (const FreeParameter& p : free) {
    if (p.kind == FreeParameter::Kind::peak_before) {
      coordinates_.push_back({Coordinate::Kind::peak, p.record, p.scale, p.lower_z(), p.upper_z()});
    }
  }
}

void SeparableSearch::add_linear(const FreeParts& parts) {
  const auto& free = space_->free();
  const auto bound = [&](double lower, double upper) {
    lower_.push_back(lower);
    upper_.push_back(upper);
  };
  // alpha and k0 enter as their sum: the one that moves bounds it.
  const FitPoint base = space_->point(std::vector<double>(space_->size(), 0.0));
  const double fixed_alpha = base.model.blocks[shape_.bouc_wen].values[0];
  bound(parts.alpha >= 0 ? 0 : fixed_alpha, 1e6);
  bound(free[static_cast<std::size_t>(parts.beta)].lower, free[static_cast<std::size_t>(parts.beta)].upper);
  for (std::size_t b = 0; b < shape_.branches; ++b) {
    const FreeParameter& c = free[static_cast<std::size_t>(parts.damping[b])];
    bound(1 / c.upper, 1 / c.lower);
  }
  for (const SeparableRecord& r : records_) {
    first_own_.push_back(static_cast<Index>(lower_.size()));
    offset_free_.push_back(r.record().offset_free);
    if (r.record().offset_free) bound(-1e6, 1e6);
    if (!r.columns().has_start) continue;
    const double most = 2 * std::max(r.record().span_mm, 1e-3);
    for (std::size_t b = 0; b < shape_.branches; ++b) bound(-most, most);
  }
}

VectorXd SeparableSearch::coordinates_of(const SeparablePoint& point) const {
  VectorXd q(static_cast<Index>(coordinates_.size()));
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& c = coordinates_[i];
    double value = 0;
    switch (c.kind) {
      case Coordinate::Kind::growing:
        value = point.growing_per_kpa;
        break;
      case Coordinate::Kind::eta:
        value = (point.growing_per_kpa - point.shrinking_per_kpa) / 2;
        break;
      case Coordinate::Kind::rate:
        value = std::log(point.rate_hz[c.index]);
        break;
      case Coordinate::Kind::delay:
        value = point.delay_s;
        break;
      case Coordinate::Kind::lag:
        value = point.lag_s;
        break;
      case Coordinate::Kind::peak:
        value = point.starts[c.index].peak_before_kpa;
        break;
    }
    q(static_cast<Index>(i)) = std::clamp(value / c.scale, c.lower, c.upper);
  }
  return q;
}

SeparablePoint SeparableSearch::moved(SeparablePoint point, const VectorXd& q) const {
  double eta = (point.growing_per_kpa - point.shrinking_per_kpa) / 2;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& c = coordinates_[i];
    const double value = q(static_cast<Index>(i)) * c.scale;
    switch (c.kind) {
      case Coordinate::Kind::growing:
        point.growing_per_kpa = value;
        break;
      case Coordinate::Kind::eta:
        eta = value;
        break;
      case Coordinate::Kind::rate:
        point.rate_hz[c.index] = std::exp(value);
        break;
      case Coordinate::Kind::delay:
        point.delay_s = value;
        break;
      case Coordinate::Kind::lag:
        point.lag_s = value;
        break;
      case Coordinate::Kind::peak:
        point.starts[c.index].peak_before_kpa = value;
        break;
    }
  }
  point.shrinking_per_kpa = point.growing_per_kpa - 2 * eta;
  return point;
}

std::vector<Index> SeparableSearch::places(std::size_t record) const {
  const SeparableColumns& c = records_[record].columns();
  std::vector<Index> places(static_cast<std::size_t>(c.linear()), -1);
  for (Index i = 0; i < c.offset(); ++i) places[static_cast<std::size_t>(i)] = i;
  Index own = first_own_[record];
  if (offset_free_[record]) places[static_cast<std::size_t>(c.offset())] = own++;
  for (Index i = c.offset() + 1; i < c.linear(); ++i) places[static_cast<std::size_t>(i)] = own++;
  return places;
}

void SeparableSearch::set_linear(SeparablePoint& point, const VectorXd& values) const {
  point.instantaneous = values(0);
  point.beta = values(1);
  for (std::size_t b = 0; b < shape_.branches; ++b) point.amplitude[b] = values(2 + static_cast<Index>(b));
  for (std::size_t k = 0; k < records_.size(); ++k) {
    Index own = first_own_[k];
    if (offset_free_[k]) point.starts[k].offset_mm = values(own++);
    if (!records_[k].columns().has_start) continue;
    for (double& unsettled : point.starts[k].unsettled_mm) unsettled = values(own++);
  }
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

MatrixXd SeparableSearch::coordinate_map(const SeparablePoint& point, std::size_t record) const {
  const SeparableColumns& c = records_[record].columns();
  MatrixXd map = MatrixXd::Zero(c.all(), static_cast<Index>(coordinates_.size()));
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& q = coordinates_[i];
    auto column = map.col(static_cast<Index>(i));
    switch (q.kind) {
      case Coordinate::Kind::growing:  // gamma + eta moves with eta kept: gamma - eta moves alike
        column(c.growing()) = column(c.shrinking()) = q.scale;
        break;
      case Coordinate::Kind::eta:
        column(c.shrinking()) = -2 * q.scale;
        break;
      case Coordinate::Kind::rate:
        column(c.rate(q.index)) = point.rate_hz[q.index];
        break;
      case Coordinate::Kind::delay:
        column(c.delay()) = q.scale;
        break;
      case Coordinate::Kind::lag:
        column(c.lag()) = q.scale;
        break;
      case Coordinate::Kind::peak:
        if (q.index == record) column(c.peak()) = q.scale;
        break;
    }
  }
  return map;
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

FitPoint SeparableSearch::to_fit_point(FitPoint start, const SeparablePoint& point) const {
  std::vector<double>& bw = start.model.blocks[shape_.bouc_wen].values;
  std::vector<double>& kv = start.model.blocks[shape_.kelvin_voigt].values;
  const double eta = (point.growing_per_kpa - point.shrinking_per_kpa) / 2;
  if (alpha_free_) {
    bw[0] = point.instantaneous - 1 / kv[0];
    if (bw[0] <= 0) {
      // The spring alone gives more than the whole: it must be stiffer.
      kv[0] = 1 / std::max(point.instantaneous, 1e-9);
      bw[0] = 0;
    }
  } else {
    kv[0] = 1 / std::max(point.instantaneous - bw[0], 1e-9);
  }
  bw[1] = point.beta;
  bw[2] = point.growing_per_kpa - eta;
  bw[3] = eta;
  for (std::size_t b = 0; b < shape_.branches; ++b) {
    kv[2 + 2 * b] = 1 / point.amplitude[b];
    kv[1 + 2 * b] = point.rate_hz[b] / point.amplitude[b];
  }
  if (shape_.delay) start.model.blocks[*shape_.delay].values[0] = point.delay_s;
  if (shape_.lag) start.model.blocks[*shape_.lag].values[0] = point.lag_s;
  start.starts = point.starts;
  return start;
}

}  // namespace softgrip::sysid
