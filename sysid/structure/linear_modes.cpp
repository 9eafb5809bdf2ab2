#include "sysid/structure/linear_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "sysid/fitting/held_out.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/resampled_record.h"
#include "sysid/structure/structure_columns.h"
#include "sysid/structure/structure_projection.h"

namespace softgrip::sysid {
namespace {

constexpr int scanned_periods = 12;
constexpr std::array scanned_damping_ratios{0.03, 0.3, 1.5, 6.0};
/// Scanned dead times, in units of time_unit_s(). A structure with a lag has no scan of the dead time.
constexpr std::array scanned_delays{0.0, 0.05, 0.15, 0.5};
/// Number of start points from which the search continues.
constexpr std::size_t continued_starts = 3;
/// Ridge penalty of the fixed set of modes, relative to the sum of squares of a column.
constexpr double set_ridge = 1e-7;

/// Returns periods at equal ratios, between the shortest and the longest period of a mode in a fit.
std::vector<double> periods_s(const StructureGrid& grid, int count) {
  const double to_s = std::max(longest_mode_s(grid), grid.shortest_period_s);
  std::vector<double> list;
  for (int i = 0; i < count; ++i)
    list.push_back(grid.shortest_period_s * std::pow(to_s / grid.shortest_period_s, (i + 0.5) / count));
  return list;
}

/// Held-out losses of linear least squares, on the blocks of a division.
class HeldOutLeastSquares {
 public:
  /// `records` and `division` must outlive the object.
  HeldOutLeastSquares(const std::vector<Record>& records, const Division& division, Eigen::MatrixXd columns)
      : records_(records), division_(division), rows_(rows_of(records)), columns_(std::move(columns)) {
    for (Eigen::Index c = 0; c < columns_.cols(); ++c) {
      const double size = columns_.col(c).norm();
      if (size > 0) columns_.col(c) /= size;
    }
  }

  [[nodiscard]] BlockLosses losses(const Eigen::VectorXd& target) const {
    BlockLosses losses(division_.blocks.size());
    for (std::size_t fold = 0; fold < division_.folds; ++fold) {
      const BlockLosses all = mean_squares(target - columns_ * weights(target, fold));
      for (std::size_t b = 0; b < losses.size(); ++b) {
        if (division_.blocks[b].fold == fold) losses[b] = all[b];
      }
    }
    return losses;
  }
  /// Returns the mean square of a series on each block.
  [[nodiscard]] BlockLosses mean_squares(const Eigen::VectorXd& series) const {
    std::vector<std::vector<double>> samples;
    for (const Record& record : records_)
      samples.emplace_back(record.size(), std::numeric_limits<double>::quiet_NaN());
    Eigen::Index next = 0;
    for (const RowPlace& row : rows_) samples[row.record][row.sample] = series(next++);
    BlockLosses losses;
    for (const Block& block : division_.blocks) losses.push_back(loss_of(samples[block.record], block));
    return losses;
  }

 private:
  [[nodiscard]] Eigen::VectorXd weights(const Eigen::VectorXd& target, std::size_t fold) const {
    const std::vector<Record> rest = without_fold(records_, division_, fold);
    Eigen::VectorXd fitted(target.size());
    Eigen::Index next = 0;
    for (const RowPlace& row : rows_)
      fitted(next++) = std::isfinite(rest[row.record].reading_mm[row.sample]) ? 1 : 0;
    const Eigen::MatrixXd used = fitted.asDiagonal() * columns_;
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
    gram.selfadjointView<Eigen::Lower>().rankUpdate(used.transpose());
    gram.diagonal().array() += set_ridge;
    return gram.selfadjointView<Eigen::Lower>().ldlt().solve(used.transpose() * target);
  }

  const std::vector<Record>& records_;
  const Division& division_;
  std::vector<RowPlace> rows_;
  Eigen::MatrixXd columns_;
};

}  // namespace

std::vector<NonlinearNumbers> starts_of_next_mode(const std::vector<Record>& records, BaseStructure structure,
                                                  const StructureGrid& grid, const NonlinearNumbers& numbers,
                                                  const StructureFitOptions& options) {
  structure.modes = numbers.modes.size() + 1;
  const ColumnLayout layout(structure, grid, records);
  const Eigen::VectorXd readings = readings_of_rows(records);
  StructureColumns columns(records, structure, grid);
  std::vector<double> delays_s{numbers.delay_s};
  if (structure.delay && !structure.lag) {
    for (const double delay : scanned_delays) delays_s.push_back(delay * grid.time_unit_s);
  }
  std::vector<std::pair<double, NonlinearNumbers>> found;
  Eigen::VectorXd near;
  for (const double delay_s : delays_s) {
    for (const double period_s : periods_s(grid, scanned_periods)) {
      std::pair<double, NonlinearNumbers> best{std::numeric_limits<double>::infinity(), numbers};
      for (const double damping_ratio : scanned_damping_ratios) {
        NonlinearNumbers trial = numbers;
        trial.delay_s = delay_s;
        trial.modes.push_back({period_s, damping_ratio});
        const ProjectionProblem problem{
            columns.at(trial), layout, readings, grid.largest_kpa, least_elastic_mm_per_kpa(grid),
            options.ridge};
        const Projection p = project(problem, {structure.characteristic ? trial.curvature : 0, grid.span_mm},
                                     near.size() > 0 ? &near : nullptr);
        near = p.weights;
        if (p.mean_square_mm2 < best.first) best = {p.mean_square_mm2, std::move(trial)};
      }
      found.push_back(std::move(best));
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  found.resize(std::min(found.size(), continued_starts));
  std::vector<NonlinearNumbers> starts;
  for (auto& [loss, start] : found) starts.push_back(std::move(start));
  return starts;
}

bool lacks_linear_dynamics(const FitPoint& point, const std::vector<Record>& records,
                           const StructureGrid& grid, const Division& division,
                           const std::vector<double>& losses_mm2) {
  const std::vector<Record> few = with_fewer_readings(records, StructureFitOptions{}.most_rows);
  BaseStructure set{.hysteretic = false,
                    .delay = false,
                    .lag = false,
                    .two_way = false,
                    .characteristic = false,
                    .linear = true};
  NonlinearNumbers numbers;
  for (const Record& record : few)
    numbers.peak_before_kpa.push_back(record.start_unknown ? record.drive_kpa.front() : 0);
  for (const double damping_ratio : {0.1, 1.0}) {
    for (const double period_s : periods_s(grid, scanned_periods))
      numbers.modes.push_back({period_s, damping_ratio});
  }
  set.modes = numbers.modes.size();
  const HeldOutLeastSquares squares(few, division, structure_columns(few, set, grid, numbers));
  const Eigen::VectorXd readings = readings_of_rows(few);
  std::vector<std::vector<double>> errors;
  for (std::size_t r = 0; r < few.size(); ++r)
    errors.push_back(residual(few[r], predict(point.model, few[r], point.starts[r])));
  Eigen::VectorXd left(readings.size());
  Eigen::Index next = 0;
  for (const RowPlace& row : rows_of(few)) left(next++) = errors[row.record][row.sample];
  return is_clearly_less(squares.losses(left), squares.mean_squares(left)) ||
         is_clearly_less(squares.losses(readings), losses_mm2);
}

}  // namespace softgrip::sysid
