#include "sysid/structure/structure_columns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/transport_delay.h"
#include "model/envelope_map.h"
#include "model/play.h"
#include "model/regulated_pressure.h"
#include "model/second_order.h"
#include "model/segment.h"
#include "model/two_way_lag.h"
#include "sysid/fitting/hysteresis_step.h"
#include "sysid/logs/each_record.h"

namespace softgrip::sysid {
namespace {

using Segment = model::Segment<double>;

/// The delay of a structure, followed by its lags and its rate limit or by its regulator. A component that
/// the structure does not have passes its input on unchanged.
class Valve {
 public:
  Valve(const Record& record, const BaseStructure& structure, const NonlinearNumbers& n, double first_kpa)
      : regulates_(structure.lag && structure.regulator),
        delay_(std::vector<double>{structure.delay ? n.delay_s : 0}, {.sample_time_s = record.sample_time_s}),
        second_(second_s(structure, n), second_s(structure, n), record.sample_time_s),
        lag_(structure.lag ? n.filling_s : 0, structure.lag ? n.venting_s : 0, record.sample_time_s),
        limit_(std::vector<double>{limits(structure) ? n.filling_s_per_kpa : 0,
                                   limits(structure) ? n.venting_s_per_kpa : 0},
               {}),
        pilot_(n.pilot_band_kpa / 2),
        regulator_({n.filling_s, n.venting_s, n.overlap_kpa, n.integral_s, n.full_open_kpa}) {
    delay_.reset(first_kpa);
    second_.reset(first_kpa);
    lag_.reset(first_kpa);
    limit_.reset(first_kpa);
    pilot_.reset(first_kpa);
    regulator_.reset(pilot_.output());
  }

  template <class Next>
  void step(const Segment& command, Next&& next) {
    delay_.step(command, {}, [&](const Segment& delayed) {
      if (!regulates_) {
        return second_.step(delayed, [&](const Segment& slower) {
          lag_.step(slower, [&](const Segment& q) { limit_.step(q, {}, next); });
        });
      }
      pilot_.step(delayed, [&](const Segment& asked) { regulator_.step(asked, next); });
    });
  }

 private:
  static double second_s(const BaseStructure& structure, const NonlinearNumbers& n) {
    return structure.lag && structure.second_lag ? n.second_s : 0;
  }

  static bool limits(const BaseStructure& structure) { return structure.lag && structure.rate_limit; }

  bool regulates_;
  model::TransportDelay<double> delay_;
  model::TwoWayLag<double> second_;
  model::TwoWayLag<double> lag_;
  model::RateLimit<double> limit_;
  model::Play<double> pilot_;
  model::RegulatedPressure<double> regulator_;
};

/// Returns true if `a` and `b` have equal parameters of delay, lags, rate limit, regulator and initial jump.
/// The pressure in the finger is then equal for both.
bool drive_alike(const NonlinearNumbers& a, const NonlinearNumbers& b) {
  return a.delay_s == b.delay_s && a.filling_s == b.filling_s && a.venting_s == b.venting_s &&
         a.second_s == b.second_s && a.filling_s_per_kpa == b.filling_s_per_kpa &&
         a.venting_s_per_kpa == b.venting_s_per_kpa && a.pilot_band_kpa == b.pilot_band_kpa &&
         a.jumped_from_kpa == b.jumped_from_kpa && a.overlap_kpa == b.overlap_kpa &&
         a.integral_s == b.integral_s && a.full_open_kpa == b.full_open_kpa;
}

/// Returns the part of a segment that lies above a threshold pressure (hinge). The pressures of the result
/// are relative to the threshold.
Segment above(const Segment& in, double hinge_kpa) {
  const double begin = in.begin - hinge_kpa, end = in.end - hinge_kpa;
  if (begin >= 0 && end >= 0) return {in.duration_s, begin, end, in.mean - hinge_kpa};
  if (begin <= 0 && end <= 0) return Segment::straight(in.duration_s, 0, 0);
  const double high = std::max(begin, end);
  return {in.duration_s, std::max(begin, 0.0), std::max(end, 0.0), high * high / (2 * std::abs(end - begin))};
}

/// State of the hysteresis: either the state of the Bouc-Wen element, or the states of all play operators.
class PressureMemory {
 public:
  PressureMemory(const BaseStructure& structure, const StructureGrid& grid, const NonlinearNumbers& numbers,
                 double first_kpa, double peak_kpa)
      : envelopes_(structure.envelopes ? numbers.envelope_bend : 0,
                   structure.envelopes ? numbers.envelope_skew : 0, grid.largest_kpa),
        bouc_wen_(structure.hysteresis == HysteresisForm::bouc_wen),
        rates_{numbers.growing_per_kpa, numbers.growing_per_kpa * (1 - 2 * numbers.narrowing)},
        steepest_(steepest_state(numbers)) {
    if (!bouc_wen_) {
      thresholds_kpa_ = Eigen::Map<const Eigen::ArrayXd>(
          grid.thresholds_kpa.data(), static_cast<Eigen::Index>(grid.thresholds_kpa.size()));
      plays_ = Eigen::ArrayXd::Zero(thresholds_kpa_.size());
      move(0, numbers.trained_kpa);
      move(numbers.trained_kpa, 0);
      untouched_ = plays_;
    }
    move(0, std::max(first_kpa, peak_kpa));
    if (peak_kpa > first_kpa) move(peak_kpa, first_kpa);
  }

  /// Updates the state after the pressure has changed monotonically from `from` to `to`.
  void move(double from, double to) {
    if (bouc_wen_) {
      if (to != from) g_ = stepped(g_, to - from, rates_);
      return;
    }
    const double seen = envelopes_.value(to);
    plays_ = plays_.max(seen - thresholds_kpa_).min(seen + thresholds_kpa_);
  }

  /// Returns the value of the envelope function at a pressure [kPa]. This value is the input of the play
  /// operators.
  [[nodiscard]] double seen_kpa(double kpa) const { return envelopes_.value(kpa); }

  template <class Row>
  void write(double kpa, Row&& row) const {
    if (bouc_wen_) row(0) = steepest_ * kpa - g_;
    for (Eigen::Index i = 0; i < plays_.size(); ++i)
      row(static_cast<std::size_t>(i)) = plays_(i) - untouched_(i);
  }

 private:
  model::EnvelopeMap<double> envelopes_;
  bool bouc_wen_;
  HysteresisRates rates_;
  /// `plays_`: current states of the play operators [kPa]. `untouched_`: their states at zero pressure after
  /// a load to the largest pressure before the logs [kPa].
  Eigen::ArrayXd plays_, untouched_;
  Eigen::ArrayXd thresholds_kpa_;  ///< thresholds of the play operators
  double g_ = 0;
  double steepest_;  ///< largest slope dg/dp of the hysteretic state g with respect to the pressure p
};

/// Weight of a creep branch without creep, as a share of the displacement range per largest pressure.
constexpr double no_creep_share = 1e-7;

std::size_t branches_of(const BaseStructure& structure, const StructureGrid& grid) {
  if (!structure.creep) return 0;
  if (structure.slow_creep) return grid.ladder_s.size();
  return static_cast<std::size_t>(
      std::lower_bound(grid.ladder_s.begin(), grid.ladder_s.end(), grid.slow_from_s) - grid.ladder_s.begin());
}

/// Returns ColumnLayout::knot_interval_s(). The largest number of knots equals that of the cause
/// sensor_drift.
double knot_interval_of(const StructureGrid& grid, const std::vector<Record>& records) {
  constexpr double units = 20, most_knots = 16;
  double longest_s = 0;
  for (const Record& record : records) longest_s = std::max(longest_s, record.length_s());
  return std::max(units * grid.time_unit_s, longest_s / most_knots);
}

}  // namespace

void drive(const Record& record, std::size_t index, const BaseStructure& structure,
           const NonlinearNumbers& numbers, DrivenPressure& driven) {
  const bool jumps = structure.linear && index < numbers.jumped_from_kpa.size();
  driven.first_kpa = jumps ? numbers.jumped_from_kpa[index] : record.drive_kpa.front();
  driven.segments.clear();
  driven.until.clear();
  driven.segments.reserve(3 * record.size());
  driven.until.reserve(record.size());
  Valve valve(record, structure, numbers, driven.first_kpa);
  const auto step = [&](double duration_s, double from_kpa, double to_kpa) {
    valve.step(Segment::straight(duration_s, from_kpa, to_kpa),
               [&](const Segment& q) { driven.segments.push_back(q); });
  };
  if (jumps) step(0, driven.first_kpa, record.drive_kpa.front());
  driven.until.push_back(driven.segments.size());
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double end = record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
    const double begin = i > 1 && record.held ? record.drive_kpa[i - 2] : record.drive_kpa[i - 1];
    if (record.held && i > 1) step(0, begin, end);
    step(record.duration_s[i], record.held ? end : begin, end);
    driven.until.push_back(driven.segments.size());
  }
}

double steepest_state(const NonlinearNumbers& numbers) {
  return std::max(1.0, 2 * numbers.narrowing);
}

double least_compliance_mm_per_kpa(double tau_s) {
  // The margin prevents that stiffness or damping exceed their upper limit due to rounding.
  constexpr double margin = 1e-9;
  const auto& [stiffness, damping] = model::KelvinVoigt<double>::repeated;
  return (1 + margin) * std::max(1 / stiffness.upper, tau_s / damping.upper);
}

ColumnLayout::ColumnLayout(const BaseStructure& structure, const StructureGrid& grid,
                           const std::vector<Record>& records)
    : hysteretic_(!structure.hysteretic                              ? 0
                  : structure.hysteresis == HysteresisForm::bouc_wen ? 1
                                                                     : grid.thresholds_kpa.size()),
      branches_(branches_of(structure, grid)),
      hinges_(structure.hinged_creep ? grid.hinges_kpa.size() : 0),
      hinge_branches_(structure.hinged_creep ? grid.hinge_ladder_s.size() : 0),
      modes_(structure.modes),
      linear_(structure.linear),
      knot_interval_s_(knot_interval_of(grid, records)) {
  count_ = own();
  for (const Record& record : records) {
    offset_.push_back(record.offset_free ? count_++ : -1);
    const bool open = record.start_unknown && branches_ > 0;
    unsettled_.push_back(open ? count_ : -1);
    if (open) count_ += static_cast<Eigen::Index>(branches_);
    const double knots = structure.zero_drift ? std::ceil(record.length_s() / knot_interval_s_ - 1e-9) : 0;
    knots_.push_back(static_cast<std::size_t>(knots));
    zero_drift_.push_back(count_);
    count_ += static_cast<Eigen::Index>(knots);
  }
  const bool needed =
      std::any_of(unsettled_.begin(), unsettled_.end(), [](Eigen::Index c) { return c >= 0; });
  for (std::size_t b = 0; b < branches_; ++b)
    least_creep_.push_back(needed ? std::max(no_creep_share * grid.span_mm / grid.largest_kpa,
                                             least_compliance_mm_per_kpa(grid.ladder_s[b]))
                                  : 0);
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

Eigen::VectorXd readings_of_rows(const std::vector<Record>& records) {
  const std::vector<RowPlace> rows = rows_of(records);
  Eigen::VectorXd readings(static_cast<Eigen::Index>(rows.size()));
  Eigen::Index next = 0;
  for (const RowPlace& row : rows) readings(next++) = records[row.record].reading_mm[row.sample];
  return readings;
}

StructureColumns::StructureColumns(const std::vector<Record>& records, const BaseStructure& structure,
                                   const StructureGrid& grid)
    : records_(records),
      structure_(structure),
      grid_(grid),
      layout_(structure, grid, records),
      first_row_(first_rows_of(records)),
      columns_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_of(records).size()), layout_.count())),
      ladder_weights_(records.size(), LadderWeights(grid.ladder_s)),
      hinge_weights_(records.size(), LadderWeights(grid.hinge_ladder_s)) {
  write_own();
}

const Eigen::MatrixXd& StructureColumns::at(const NonlinearNumbers& numbers) {
  const bool driven_alike = !driven_.empty() && drive_alike(numbers_, numbers);
  NonlinearNumbers same = numbers;
  same.curvature = numbers_.curvature;  // the columns do not depend on the curvature
  if (driven_alike && same == numbers_) return columns_;
  const std::vector<ModeNumbers> modes = std::exchange(same.modes, numbers_.modes);
  const bool alike_except_modes = driven_alike && same == numbers_;
  const std::vector<ModeNumbers> last_modes = std::exchange(numbers_, numbers).modes;
  driven_.resize(records_.size());
  for_each_record(records_, [&](std::size_t r) {
    if (!driven_alike) {
      drive(records_[r], r, structure_, numbers, driven_[r]);
      write_driven(r);
    }
    for (std::size_t k = 0; k < layout_.modes(); ++k) {
      if (!driven_alike || k >= last_modes.size() || last_modes[k] != modes[k]) write_mode(r, k);
    }
    if (layout_.hysteretic() > 0 && !alike_except_modes) write_hysteresis(r);
  });
  return columns_;
}

/// Writes the columns of elastic gain and creep. These columns depend only on the pressure in the finger. If
/// the structure has envelopes, write_hysteresis() overwrites the column of the elastic gain.
void StructureColumns::write_driven(std::size_t r) {
  const DrivenPressure& driven = driven_[r];
  Ladder ladder(ladder_weights_[r], driven.first_kpa);
  std::vector<Ladder> hinged;
  for (std::size_t h = 0; h < layout_.hinges(); ++h)
    hinged.emplace_back(hinge_weights_[r], std::max(driven.first_kpa - grid_.hinges_kpa[h], 0.0));
  auto row = static_cast<Eigen::Index>(first_row_[r]);
  std::size_t segment = 0;
  for (std::size_t i = 0; i < driven.until.size(); ++i) {
    for (; segment < driven.until[i]; ++segment) {
      const Segment& q = driven.segments[segment];
      if (structure_.creep) ladder.step(q);
      for (std::size_t h = 0; h < hinged.size(); ++h) hinged[h].step(above(q, grid_.hinges_kpa[h]));
    }
    if (!std::isfinite(records_[r].reading_mm[i])) continue;
    columns_(row, ColumnLayout::elastic()) = driven.at_kpa(i);
    for (std::size_t b = 0; b < layout_.branches(); ++b) columns_(row, layout_.creep(b)) = ladder.value(b);
    for (std::size_t h = 0; h < hinged.size(); ++h) {
      for (std::size_t b = 0; b < layout_.hinge_branches(); ++b)
        columns_(row, layout_.hinged(h, b)) = hinged[h].value(b);
    }
    ++row;
  }
}

/// Writes the two columns of a linear mode.
void StructureColumns::write_mode(std::size_t r, std::size_t k) {
  const DrivenPressure& driven = driven_[r];
  const ModeNumbers& mode = numbers_.modes[k];
  model::SecondOrder<double> system(2 * std::numbers::pi / mode.period_s, mode.damping_ratio);
  system.reset(driven.first_kpa);
  auto row = static_cast<Eigen::Index>(first_row_[r]);
  std::size_t segment = 0;
  for (std::size_t i = 0; i < driven.until.size(); ++i) {
    for (; segment < driven.until[i]; ++segment) {
      if (driven.segments[segment].duration_s > 0) system.advance(driven.segments[segment]);
    }
    if (!std::isfinite(records_[r].reading_mm[i])) continue;
    columns_(row, layout_.mode(k)) = system.value();
    columns_(row, layout_.mode(k) + 1) = system.rate() / system.omega();
    ++row;
  }
}

void StructureColumns::write_hysteresis(std::size_t r) {
  const DrivenPressure& driven = driven_[r];
  PressureMemory memory(structure_, grid_, numbers_, driven.first_kpa,
                        records_[r].start_unknown ? numbers_.peak_before_kpa[r] : 0);
  auto row = static_cast<Eigen::Index>(first_row_[r]);
  std::size_t segment = 0;
  for (std::size_t i = 0; i < driven.until.size(); ++i) {
    for (; segment < driven.until[i]; ++segment)
      memory.move(driven.segments[segment].begin, driven.segments[segment].end);
    if (!std::isfinite(records_[r].reading_mm[i])) continue;
    if (structure_.envelopes) columns_(row, ColumnLayout::elastic()) = memory.seen_kpa(driven.at_kpa(i));
    memory.write(driven.at_kpa(i),
                 [&](std::size_t k) -> double& { return columns_(row, ColumnLayout::hysteresis(k)); });
    ++row;
  }
}

/// Writes the columns that belong to single records: offset, unsettled creep and drift. These columns do not
/// depend on the nonlinear parameters.
void StructureColumns::write_own() {
  for (std::size_t r = 0; r < records_.size(); ++r) {
    const Record& record = records_[r];
    auto row = static_cast<Eigen::Index>(first_row_[r]);
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (!std::isfinite(record.reading_mm[i])) continue;
      const double since_s = record.time_s[i] - record.time_s.front();
      if (layout_.offset(r) >= 0) columns_(row, layout_.offset(r)) = 1;
      for (std::size_t b = 0; layout_.unsettled(r) >= 0 && b < layout_.branches(); ++b) {
        columns_(row, layout_.unsettled(r) + static_cast<Eigen::Index>(b)) =
            std::exp(-since_s / grid_.ladder_s[b]);
      }
      for (std::size_t k = 0; k < layout_.knots(r); ++k) {
        const double knots_away = since_s / layout_.knot_interval_s() - static_cast<double>(k + 1);
        columns_(row, layout_.zero_drift(r) + static_cast<Eigen::Index>(k)) =
            std::max(0.0, 1 - std::abs(knots_away));
      }
      ++row;
    }
  }
}

Eigen::MatrixXd structure_columns(const std::vector<Record>& records, const BaseStructure& structure,
                                  const StructureGrid& grid, const NonlinearNumbers& numbers) {
  return StructureColumns(records, structure, grid).at(numbers);
}

}  // namespace softgrip::sysid
