#include "sysid/structure/structure_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "model/envelope_map.h"
#include "sysid/fitting/descent.h"
#include "sysid/logs/resampled_record.h"
#include "sysid/structure/structure_columns.h"
#include "sysid/structure/structure_projection.h"

namespace softgrip::sysid {
namespace {

/// Penalty for a parameter at a distance of one prior width from its prior value. The penalty is added to the
/// logarithm of the sum of squared residuals.
constexpr double prior = 0.05;
/// Upper limit of the dead band of a regulator, as a share of the largest pressure. Data sheets state values
/// from 0.005 to 0.02.
constexpr double widest_of_a_regulator = 0.03;
/// Prior width of the bend and of the skew of an envelope. With twice this width, envelopes would fit the
/// saturation of a sensor and thereby hide the saturation (seen in the textbook test cases).
constexpr double usual_bend = 0.05;
/// Prior width of the logarithms of the period and of the damping ratio of a linear mode.
constexpr double mode_width = 3;

/// A nonlinear parameter of the search. It is scaled to a coordinate t whose magnitude is about 1.
struct Coordinate {
  std::function<double(const NonlinearNumbers&)> get;
  std::function<void(NonlinearNumbers&, double)> set;
  double centre = 0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// True: the pressure in the finger depends on this parameter, so a derivative needs a new simulation of
  /// the pressure.
  bool drives = false;
};

Coordinate straight(double NonlinearNumbers::*member, double width, double centre, double lower,
                    double upper) {
  return {[=](const NonlinearNumbers& n) { return n.*member / width; },
          [=](NonlinearNumbers& n, double t) { n.*member = t * width; }, centre / width, lower / width,
          upper / width};
}

Coordinate logarithmic(double NonlinearNumbers::*member, double width, double centre, double lower,
                       double upper) {
  return {[=](const NonlinearNumbers& n) { return std::log(n.*member) / width; },
          [=](NonlinearNumbers& n, double t) { n.*member = std::exp(t * width); }, std::log(centre) / width,
          std::log(lower) / width, std::log(upper) / width};
}

class Search {
 public:
  Search(const std::vector<Record>& records, const BaseStructure& structure, const StructureGrid& grid,
         const StructureFitOptions& options)
      : records_(records),
        structure_(structure),
        grid_(grid),
        options_(options),
        layout_(structure, grid, records),
        readings_(readings_of_rows(records)),
        columns_(records, structure_, grid) {
    add_coordinates();
  }

  struct State {
    NonlinearNumbers numbers;
    Projection projection;
    Eigen::VectorXd residual;  ///< prediction errors, followed by the ridge penalties of the weights
    double value = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] State at(const NonlinearNumbers& numbers, const Eigen::VectorXd* near = nullptr) {
    return at(columns_, numbers, near);
  }
  [[nodiscard]] State at(StructureColumns& columns, const NonlinearNumbers& numbers,
                         const Eigen::VectorXd* near) const {
    State state;
    state.numbers = numbers;
    const ProjectionProblem problem{
        columns.at(numbers), layout_, readings_, grid_.largest_kpa, least_elastic_mm_per_kpa(grid_),
        options_.ridge};
    state.projection =
        project(problem, {structure_.characteristic ? numbers.curvature : 0, grid_.span_mm}, near);
    const Projection& p = state.projection;
    state.residual.resize(p.error_mm.size() + p.penalty_mm.size());
    state.residual << p.error_mm, p.penalty_mm;
    state.value = std::log(std::max(state.residual.squaredNorm(), 1e-300));
    for (const Coordinate& c : coordinates_) state.value += prior * std::pow(c.get(numbers) - c.centre, 2);
    return state;
  }

  [[nodiscard]] Descent<State> run(const NonlinearNumbers& start) {
    return descend(*this, at(start),
                   {.most_steps = options_.most_iterations, .most_trials = 8, .least_gain = 1e-5});
  }

  [[nodiscard]] static double loss(const State& state) { return state.value; }

  [[nodiscard]] NormalEquations normal(const State& state) {
    const auto n = static_cast<Eigen::Index>(coordinates_.size());
    Eigen::MatrixXd jacobian(state.residual.size(), n);
    NormalEquations normal;
    // The parameters that do not affect the pressure in the finger are changed first. During these changes,
    // the pressure that was computed for the current state stays valid. The other parameters need a new
    // simulation each, so a second thread with its own columns computes every second one of them.
    std::array<std::vector<Eigen::Index>, 2> parts;
    std::size_t driving = 0;
    for (const bool drives : {false, true}) {
      for (Eigen::Index k = 0; k < n; ++k) {
        if (coordinates_[static_cast<std::size_t>(k)].drives == drives)
          parts[drives ? ++driving % 2 : 0].push_back(k);
      }
    }
    if (!parts[1].empty() && !beside_) beside_.emplace(columns_);
    parallel_for_idle(parts.size(), [&](std::size_t part) {
      for (const Eigen::Index k : parts[part]) {
        const Coordinate& c = coordinates_[static_cast<std::size_t>(k)];
        const double t = c.get(state.numbers);
        const double h = t + 1e-4 > c.upper ? -1e-4 : 1e-4;
        NonlinearNumbers beside = state.numbers;
        c.set(beside, t + h);
        const State there = at(part == 0 ? columns_ : *beside_, beside, &state.projection.weights);
        jacobian.col(k) = (there.residual - state.residual) / h;
      }
    });
    const double sum = state.residual.squaredNorm();
    normal.curvature = jacobian.transpose() * jacobian / sum;
    normal.gradient = jacobian.transpose() * state.residual / sum;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Coordinate& c = coordinates_[static_cast<std::size_t>(k)];
      normal.curvature(k, k) += prior;
      normal.gradient(k) += prior * (c.get(state.numbers) - c.centre);
    }
    return normal;
  }

  [[nodiscard]] StepBounds bounds(const State& state) const {
    const auto n = static_cast<Eigen::Index>(coordinates_.size());
    StepBounds bounds{Eigen::VectorXd(n), Eigen::VectorXd(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const Coordinate& c = coordinates_[static_cast<std::size_t>(k)];
      const double t = c.get(state.numbers);
      // A bound is converted to a logarithm and back, which causes a rounding error. Values within 1e-9 of
      // the bound therefore count as equal to the bound.
      bounds.lower(k) = t <= c.lower + 1e-9 ? 0 : c.lower - t;
      bounds.upper(k) = t >= c.upper - 1e-9 ? 0 : c.upper - t;
    }
    return bounds;
  }

  [[nodiscard]] State moved(const State& from, const Eigen::VectorXd& step) {
    NonlinearNumbers numbers = from.numbers;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      const double t = c.get(from.numbers) + step(static_cast<Eigen::Index>(k));
      c.set(numbers, std::clamp(t, c.lower, c.upper));
    }
    return at(numbers, &from.projection.weights);
  }

 private:
  void add_driving(Coordinate coordinate) {
    coordinate.drives = true;
    coordinates_.push_back(std::move(coordinate));
  }

  void add_coordinates() {
    using N = NonlinearNumbers;
    const double unit_s = grid_.time_unit_s;
    const auto lag = [unit_s](double N::*member) {
      return logarithmic(member, 1.5, 0.1 * unit_s, 1e-4 * unit_s, 10 * unit_s);
    };
    if (structure_.delay) add_driving(straight(&N::delay_s, 0.2 * unit_s, 0, 0, 5 * unit_s));
    if (structure_.lag) {
      if (structure_.two_way) {
        add_driving(lag(&N::filling_s));
        add_driving(lag(&N::venting_s));
      } else {
        Coordinate both = lag(&N::filling_s);
        const auto set = both.set;
        both.set = [set](N& n, double t) {
          set(n, t);
          n.venting_s = n.filling_s;
        };
        add_driving(std::move(both));
      }
    }
    if (structure_.lag && structure_.second_lag) add_driving(lag(&N::second_s));
    if (structure_.lag && structure_.rate_limit) {
      for (double N::*s_per_kpa : {&N::filling_s_per_kpa, &N::venting_s_per_kpa})
        add_driving(logarithmic(s_per_kpa, 1.5, unit_s / grid_.largest_kpa, 1e-4 * unit_s / grid_.largest_kpa,
                                1e3 * unit_s / grid_.largest_kpa));
    }
    if (structure_.lag && structure_.regulator) {
      // The dead band of a regulator has an upper limit. Without this limit, the search could represent
      // backlash of the finger by the dead band.
      const double widest_kpa = widest_of_a_regulator * grid_.largest_kpa;
      add_driving(straight(&N::pilot_band_kpa, 1, 0, 0, widest_kpa));
      add_driving(straight(&N::overlap_kpa, 1, 0, 0, widest_kpa));
      add_driving(logarithmic(&N::integral_s, 1.5, 0.5 * unit_s, 0.02 * unit_s, 100 * unit_s));
      add_driving(logarithmic(&N::full_open_kpa, 1.5, 15, 1, 1000));
    }
    for (std::size_t k = 0; k < structure_.modes; ++k) add_mode(k);
    if (structure_.characteristic) coordinates_.push_back(straight(&N::curvature, 1, 0, -4, 4));
    if (structure_.envelopes) {
      using Envelope = model::EnvelopeMap<double>;
      for (const auto& [number, most] : {std::pair{&N::envelope_bend, Envelope::most_bend},
                                         std::pair{&N::envelope_skew, Envelope::most_skew}})
        coordinates_.push_back(straight(number, usual_bend, 0, -most, most));
    }
    if (structure_.hysteretic && structure_.hysteresis == HysteresisForm::bouc_wen) {
      const double growing = 3 / grid_.largest_kpa;
      coordinates_.push_back(logarithmic(&N::growing_per_kpa, 1.5, growing, growing / 300, growing * 300));
      coordinates_.push_back(straight(&N::narrowing, 0.3, 0.5, 0.02, 1));
    }
    if (structure_.hysteretic && structure_.hysteresis == HysteresisForm::play)
      coordinates_.push_back(straight(&N::trained_kpa, grid_.largest_kpa, 0, 0, 2 * grid_.largest_kpa));
    for (std::size_t r = 0; r < records_.size(); ++r) add_start(r);
  }

  /// Adds the pressure before a record if it is unknown: the last peak or, for a linear structure, the
  /// pressure before the jump.
  void add_start(std::size_t r) {
    const bool linear = structure_.linear;
    if (linear ? records_[r].start == Start::rest : !records_[r].start_unknown) return;
    std::vector<double> NonlinearNumbers::*before =
        linear ? &NonlinearNumbers::jumped_from_kpa : &NonlinearNumbers::peak_before_kpa;
    const double width = grid_.largest_kpa, first = records_[r].drive_kpa.front() / width;
    coordinates_.push_back({[=](const NonlinearNumbers& n) { return (n.*before)[r] / width; },
                            [=](NonlinearNumbers& n, double t) { (n.*before)[r] = t * width; }, first,
                            linear ? first - 2 : first, linear ? first + 2 : 1, linear});
  }

  /// Adds the logarithms of period and damping ratio of a mode, with wide priors.
  void add_mode(std::size_t k) {
    const auto add = [&](double ModeNumbers::*member, double centre, double lower, double upper) {
      coordinates_.push_back(
          {[=](const NonlinearNumbers& n) { return std::log(n.modes[k].*member) / mode_width; },
           [=](NonlinearNumbers& n, double t) { n.modes[k].*member = std::exp(t * mode_width); },
           std::log(centre) / mode_width, std::log(lower) / mode_width, std::log(upper) / mode_width});
    };
    const double from_s = grid_.shortest_period_s, to_s = std::max(longest_mode_s(grid_), 2 * from_s);
    add(&ModeNumbers::period_s, std::sqrt(from_s * to_s), from_s, to_s);
    add(&ModeNumbers::damping_ratio, 0.5, 0.005, 100);
  }

  const std::vector<Record>& records_;
  BaseStructure structure_;
  const StructureGrid& grid_;
  StructureFitOptions options_;
  ColumnLayout layout_;
  Eigen::VectorXd readings_;
  std::vector<Coordinate> coordinates_;
  StructureColumns columns_;
  std::optional<StructureColumns> beside_;  ///< columns for the second thread in normal()
};

std::vector<NonlinearNumbers> starts_for(const std::vector<Record>& records, const StructureGrid& grid) {
  std::vector<double> peaks;
  for (const Record& record : records) peaks.push_back(record.start_unknown ? record.drive_kpa.front() : 0);
  const auto start = [&](double delay_s, double filling_s, double venting_s, double growing, double trained) {
    return NonlinearNumbers{.delay_s = delay_s * grid.time_unit_s,
                            .filling_s = filling_s * grid.time_unit_s,
                            .venting_s = venting_s * grid.time_unit_s,
                            .growing_per_kpa = growing / grid.largest_kpa,
                            .trained_kpa = trained * grid.largest_kpa,
                            .peak_before_kpa = peaks};
  };
  // The three start points describe a fast valve, a valve whose dead time exceeds its lag, and a slow valve.
  return {start(0.02, 0.15, 0.15, 2, 0), start(0.15, 0.05, 0.05, 6, 1.2), start(0.1, 0.5, 1.5, 3, 0.5)};
}

/// Returns each start point with several rate limits, which replace three quarters of each lag. A lag that
/// was fitted to a ramp of duration T has a time constant of about T / 1.5. The share of the pressure range
/// that the ramp covers is unknown. A rate limit that is too fast has no effect, so three shares are tried.
/// Start points that already contain rate limits are returned unchanged.
std::vector<NonlinearNumbers> with_rate_limits(const std::vector<NonlinearNumbers>& starts,
                                               const StructureGrid& grid) {
  std::vector<NonlinearNumbers> limited;
  for (NonlinearNumbers start : starts) {
    if (start.filling_s_per_kpa > 0) return starts;
    const double filling_s = std::exchange(start.filling_s, start.filling_s / 4);
    const double venting_s = std::exchange(start.venting_s, start.venting_s / 4);
    for (const double share : {1.0, 0.2, 0.04}) {
      start.filling_s_per_kpa = 1.5 * filling_s / (share * grid.largest_kpa);
      start.venting_s_per_kpa = 1.5 * venting_s / (share * grid.largest_kpa);
      limited.push_back(start);
    }
  }
  return limited;
}

}  // namespace

NonlinearNumbers with_usual_regulator(NonlinearNumbers numbers, const StructureGrid& grid) {
  const double unit_s = grid.time_unit_s;
  numbers.filling_s = std::clamp(numbers.filling_s, 1e-3 * unit_s, 0.03 * unit_s);
  numbers.venting_s = std::clamp(numbers.venting_s, 1e-3 * unit_s, 0.05 * unit_s);
  numbers.pilot_band_kpa = 0.006 * grid.largest_kpa;
  numbers.overlap_kpa = 0.006 * grid.largest_kpa;
  numbers.integral_s = 0.4 * unit_s;
  numbers.full_open_kpa = 0.2 * grid.largest_kpa;
  return numbers;
}

FittedStructure fit_form(const std::vector<Record>& records, const BaseStructure& structure,
                         const StructureGrid& grid, const StructureFitOptions& options,
                         const NonlinearNumbers* near) {
  const std::vector<Record> few = with_fewer_readings(records, options.most_rows);
  FittedStructure fit{structure, grid, {}, {}, 0, options.ridge, false, {}};
  double best = std::numeric_limits<double>::infinity();
  std::vector<NonlinearNumbers> starts = near != nullptr ? std::vector{*near} : starts_for(records, grid);
  if (structure.rate_limit) starts = with_rate_limits(starts, grid);
  for (NonlinearNumbers& start : starts) {
    for (std::size_t r = start.jumped_from_kpa.size(); structure.linear && r < records.size(); ++r)
      start.jumped_from_kpa.push_back(records[r].drive_kpa.front());
  }
  if (const std::size_t modes = starts.front().modes.size(); modes < structure.modes) {
    BaseStructure simpler = structure;
    --simpler.modes;
    const bool is_next = modes == simpler.modes;
    const NonlinearNumbers fewer =
        is_next ? starts.front() : fit_form(records, simpler, grid, options, near).numbers;
    starts.clear();
    for (StartOfMode& start : starts_of_next_mode(few, structure, grid, fewer, options))
      starts.push_back(std::move(start.numbers));
  }
  std::vector<Descent<Search::State>> runs(starts.size());
  parallel_for_idle(starts.size(), [&](std::size_t i) {
    NonlinearNumbers start = starts[i];
    if (!structure.delay) start.delay_s = 0;
    if (!structure.lag) start.filling_s = start.venting_s = 0;
    if (!structure.linear) start.jumped_from_kpa.clear();
    if (structure.second_lag && start.second_s == 0) start.second_s = start.filling_s / 2;
    Search look(few, structure, grid, options);
    runs[i] = look.run(start);
  });
  for (const auto& [found, steps, converged] : runs) {
    fit.start_rmse_mm.push_back(std::sqrt(found.projection.mean_square_mm2));
    if (!(found.value < best)) continue;
    best = found.value;
    fit.numbers = found.numbers;
    fit.converged = converged;
  }
  Search all(records, structure, grid, options);
  const Search::State end = all.at(fit.numbers);
  fit.weights = end.projection.weights;
  fit.mean_square_mm2 = end.projection.mean_square_mm2;
  return fit;
}

std::vector<Record> without_zero_drift(std::vector<Record> records, BaseStructure structure,
                                       const StructureFitOptions& options) {
  structure.zero_drift = true;
  const FittedStructure fit = fit_form(records, structure, grid_for(records), options);
  const ColumnLayout layout(fit.structure, fit.grid, records);
  const Eigen::MatrixXd columns = structure_columns(records, fit.structure, fit.grid, fit.numbers);
  Eigen::Index row = 0;
  for (const RowPlace& place : rows_of(records)) {
    const Eigen::Index first = layout.zero_drift(place.record);
    const auto knots = static_cast<Eigen::Index>(layout.knots(place.record));
    records[place.record].reading_mm[place.sample] -=
        columns.row(row++).segment(first, knots).dot(fit.weights.segment(first, knots));
  }
  return records;
}

}  // namespace softgrip::sysid
