#include "sysid/structure/structure_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>

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

/// Returns periods at equal ratios, between the shortest and the longest period of a mode in a fit.
std::vector<double> periods_s(const StructureGrid& grid, int count) {
  const double to_s = std::max(longest_mode_s(grid), grid.shortest_period_s);
  std::vector<double> list;
  for (int i = 0; i < count; ++i)
    list.push_back(grid.shortest_period_s * std::pow(to_s / grid.shortest_period_s, (i + 0.5) / count));
  return list;
}

}  // namespace

std::vector<StartOfMode> starts_of_next_mode(const std::vector<Record>& records, BaseStructure structure,
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
  std::vector<StartOfMode> found;
  Eigen::VectorXd near;
  for (const double delay_s : delays_s) {
    for (const double period_s : periods_s(grid, scanned_periods)) {
      StartOfMode best{std::numeric_limits<double>::infinity(), numbers};
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
        if (p.mean_square_mm2 < best.mean_square_mm2) best = {p.mean_square_mm2, std::move(trial)};
      }
      found.push_back(std::move(best));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const StartOfMode& a, const StartOfMode& b) {
    return a.mean_square_mm2 < b.mean_square_mm2;
  });
  found.resize(std::min(found.size(), continued_starts));
  return found;
}

}  // namespace softgrip::sysid
