// Defines the coordinates of SeparableSearch, and converts parameters to coordinates and back.

#include <algorithm>
#include <cmath>

#include "sysid/fitting/separable_free_parts.h"
#include "sysid/fitting/separable_search.h"

namespace softgrip::sysid {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void SeparableSearch::add_coordinates(const FreeParts& parts) {
  const auto& free = space_->free();
  double largest_kpa = 0;
  double longest_s = 0;
  double shortest_s = 1e9;
  for (const SeparableRecord& r : records_) {
    const Record& record = r.record();
    largest_kpa = std::max(largest_kpa, record.largest_kpa);
    longest_s = std::max(longest_s, record.length_s());
    shortest_s = std::min(shortest_s, record.length_s() / static_cast<double>(record.size()));
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
    // A branch whose time constant exceeds 20 lengths of the log acts like a dashpot. A branch whose time
    // constant is below half a sampling interval acts like a spring.
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
  // The data determine only the sum alpha + 1/k0, so this sum is fitted. Its lower bound is 0 if alpha is
  // free. If alpha is fixed, the lower bound is the value of alpha.
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

MatrixXd SeparableSearch::coordinate_map(const SeparablePoint& point, std::size_t record) const {
  const SeparableColumns& c = records_[record].columns();
  MatrixXd map = MatrixXd::Zero(c.all(), static_cast<Index>(coordinates_.size()));
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& q = coordinates_[i];
    auto column = map.col(static_cast<Index>(i));
    switch (q.kind) {
      case Coordinate::Kind::growing:  // eta is constant here, so gamma - eta changes as much as gamma + eta
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

FitPoint SeparableSearch::to_fit_point(FitPoint start, const SeparablePoint& point) const {
  std::vector<double>& bw = start.model.blocks[shape_.bouc_wen].values;
  std::vector<double>& kv = start.model.blocks[shape_.kelvin_voigt].values;
  const double eta = (point.growing_per_kpa - point.shrinking_per_kpa) / 2;
  if (alpha_free_) {
    bw[0] = point.instantaneous - 1 / kv[0];
    if (bw[0] <= 0) {
      // The compliance 1/k0 alone would exceed the fitted sum alpha + 1/k0, so the stiffness k0 is increased.
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
