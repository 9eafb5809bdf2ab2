#include "sysid/structure/structure_columns.h"

#include <algorithm>
#include <cmath>

#include "model/blocks/transport_delay.h"
#include "model/exponential.h"
#include "model/segment.h"
#include "model/two_way_lag.h"
#include "model/weight_cache.h"
#include "sysid/fitting/hysteresis_step.h"

namespace softgrip::sysid {
namespace {

using Segment = model::Segment<double>;
using Weights = model::ExponentialWeights<double>;

/// The branches of a ladder, all behind the same signal.
class Ladder {
 public:
  Ladder(const std::vector<double>& time_constants_s, double at)
      : time_constants_s_(time_constants_s),
        x_(time_constants_s.size(), at),
        weights_(time_constants_s.size()) {}

  void step(const Segment& in) {
    if (x_.empty() || in.duration_s <= 0) return;
    const Weights* w = weights_.at(in.duration_s, [&](std::span<Weights> out) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        const double rate = 1 / time_constants_s_[i];
        out[i] = Weights::make(in.duration_s, rate, rate);
      }
    });
    const double bend = in.bend();
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = w[i].end(x_[i], in, bend);
  }
  [[nodiscard]] const std::vector<double>& values() const { return x_; }

 private:
  const std::vector<double>& time_constants_s_;
  std::vector<double> x_;
  model::WeightCache<double> weights_;
};

/// The part of a segment above a hinge, as a segment of its own.
Segment above(const Segment& in, double hinge_kpa) {
  const double begin = in.begin - hinge_kpa, end = in.end - hinge_kpa;
  if (begin >= 0 && end >= 0) return {in.duration_s, begin, end, in.mean - hinge_kpa};
  if (begin <= 0 && end <= 0) return Segment::straight(in.duration_s, 0, 0);
  const double high = std::max(begin, end);
  return {in.duration_s, std::max(begin, 0.0), std::max(end, 0.0), high * high / (2 * std::abs(end - begin))};
}

/// Everything that remembers, for one record.
class Finger {
 public:
  Finger(const BaseStructure& structure, const StructureGrid& grid, const NonlinearNumbers& numbers,
         const Record& record, double peak_kpa)
      : structure_(structure),
        grid_(grid),
        rates_{numbers.growing_per_kpa, numbers.growing_per_kpa * (1 - 2 * numbers.narrowing)},
        lag_(structure.lag ? numbers.filling_s : 0, structure.lag ? numbers.venting_s : 0,
             record.sample_time_s),
        delay_(std::vector<double>{structure.delay ? numbers.delay_s : 0},
               {.sample_time_s = record.sample_time_s}),
        ladder_(grid.ladder_s, record.drive_kpa.front()),
        steepest_(steepest_state(numbers)),
        q_(record.drive_kpa.front()) {
    delay_.reset(q_);
    lag_.reset(q_);
    for (const double hinge : grid.hinges_kpa)
      hinged_.emplace_back(grid.hinge_ladder_s, std::max(q_ - hinge, 0.0));
    if (structure.hysteresis == HysteresisForm::play) {
      plays_.resize(grid.thresholds_kpa.size(), 0);
      move(0, numbers.trained_kpa);
      move(numbers.trained_kpa, 0);
      untouched_ = plays_;
    }
    move(0, std::max(q_, peak_kpa));
    if (peak_kpa > q_) move(peak_kpa, q_);
  }

  void step(double duration_s, double from_kpa, double to_kpa) {
    delay_.step(Segment::straight(duration_s, from_kpa, to_kpa), {}, [this](const Segment& delayed) {
      lag_.step(delayed, [this](const Segment& q) { take(q); });
    });
  }

  template <class Row>
  void write(const ColumnLayout& layout, Row&& row) const {
    row(ColumnLayout::elastic()) = q_;
    for (std::size_t i = 0; i < plays_.size() && i < layout.hysteretic(); ++i)
      row(layout.hysteresis(i)) = plays_[i] - untouched_[i];
    if (structure_.hysteresis == HysteresisForm::bouc_wen && layout.hysteretic() == 1)
      row(1) = steepest_ * q_ - g_;
    for (std::size_t b = 0; b < layout.branches(); ++b) row(layout.creep(b)) = ladder_.values()[b];
    for (std::size_t h = 0; h < layout.hinges(); ++h) {
      for (std::size_t b = 0; b < layout.hinge_branches(); ++b)
        row(layout.hinged(h, b)) = hinged_[h].values()[b];
    }
  }

 private:
  void take(const Segment& q) {
    move(q.begin, q.end);
    q_ = q.end;
    if (structure_.creep) ladder_.step(q);
    if (structure_.hinged_creep) {
      for (std::size_t h = 0; h < hinged_.size(); ++h) hinged_[h].step(above(q, grid_.hinges_kpa[h]));
    }
  }
  /// The hysteresis, through a monotone change.
  void move(double from, double to) {
    if (structure_.hysteresis == HysteresisForm::bouc_wen) {
      if (to != from) g_ = stepped(g_, to - from, rates_);
      return;
    }
    for (std::size_t i = 0; i < plays_.size(); ++i) {
      plays_[i] = std::clamp(plays_[i], to - grid_.thresholds_kpa[i], to + grid_.thresholds_kpa[i]);
    }
  }

  const BaseStructure& structure_;
  const StructureGrid& grid_;
  HysteresisRates rates_;
  model::TwoWayLag<double> lag_;
  model::TransportDelay<double> delay_;
  Ladder ladder_;
  std::vector<Ladder> hinged_;
  std::vector<double> plays_, untouched_;  ///< now, and where the finger's past left them
  double g_ = 0;
  double steepest_;  ///< dg/dp is never above it
  double q_;
};

std::size_t branches_of(const BaseStructure& structure, const StructureGrid& grid) {
  if (!structure.creep) return 0;
  if (structure.slow_creep) return grid.ladder_s.size();
  return static_cast<std::size_t>(
      std::lower_bound(grid.ladder_s.begin(), grid.ladder_s.end(), grid.slow_from_s) - grid.ladder_s.begin());
}

}  // namespace

double steepest_state(const NonlinearNumbers& numbers) {
  return std::max(1.0, 2 * numbers.narrowing);
}

ColumnLayout::ColumnLayout(const BaseStructure& structure, const StructureGrid& grid,
                           const std::vector<Record>& records)
    : hysteretic_(!structure.hysteretic                              ? 0
                  : structure.hysteresis == HysteresisForm::bouc_wen ? 1
                                                                     : grid.thresholds_kpa.size()),
      branches_(branches_of(structure, grid)),
      hinges_(structure.hinged_creep ? grid.hinges_kpa.size() : 0),
      hinge_branches_(structure.hinged_creep ? grid.hinge_ladder_s.size() : 0) {
  count_ = own();
  for (const Record& record : records) {
    offset_.push_back(record.offset_free ? count_++ : -1);
    const bool open = record.start_unknown && branches_ > 0;
    unsettled_.push_back(open ? count_ : -1);
    if (open) count_ += static_cast<Eigen::Index>(branches_);
    const double knots = structure.wandering ? std::ceil(record.length_s() / knot_interval_s) : 0;
    knots_.push_back(static_cast<std::size_t>(knots));
    wandering_.push_back(count_);
    count_ += static_cast<Eigen::Index>(knots);
  }
}

std::vector<RowPlace> rows_of(const std::vector<Record>& records) {
  std::vector<RowPlace> rows;
  for (std::size_t r = 0; r < records.size(); ++r) {
    for (std::size_t i = 0; i < records[r].size(); ++i) {
      if (std::isfinite(records[r].reading_mm[i])) rows.push_back({r, i});
    }
  }
  return rows;
}

Eigen::MatrixXd structure_columns(const std::vector<Record>& records, const BaseStructure& structure,
                                  const StructureGrid& grid, const NonlinearNumbers& numbers) {
  const ColumnLayout layout(structure, grid, records);
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_of(records).size()), layout.count());
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    Finger finger(structure, grid, numbers, record, record.start_unknown ? numbers.peak_before_kpa[r] : 0);
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (i > 0) {
        const double end = record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
        const double begin = i > 1 && record.held ? record.drive_kpa[i - 2] : record.drive_kpa[i - 1];
        if (record.held && i > 1) finger.step(0, begin, end);
        finger.step(record.duration_s[i], record.held ? end : begin, end);
      }
      if (!std::isfinite(record.reading_mm[i])) continue;
      finger.write(layout, [&](Eigen::Index c) -> double& { return columns(row, c); });
      if (layout.offset(r) >= 0) columns(row, layout.offset(r)) = 1;
      for (std::size_t b = 0; layout.unsettled(r) >= 0 && b < layout.branches(); ++b) {
        columns(row, layout.unsettled(r) + static_cast<Eigen::Index>(b)) =
            std::exp(-(record.time_s[i] - record.time_s.front()) / grid.ladder_s[b]);
      }
      for (std::size_t k = 0; k < layout.knots(r); ++k) {
        const double knots_away = (record.time_s[i] - record.time_s.front()) / ColumnLayout::knot_interval_s -
                                  static_cast<double>(k + 1);
        columns(row, layout.wandering(r) + static_cast<Eigen::Index>(k)) =
            std::max(0.0, 1 - std::abs(knots_away));
      }
      ++row;
    }
  }
  return columns;
}

}  // namespace softgrip::sysid
