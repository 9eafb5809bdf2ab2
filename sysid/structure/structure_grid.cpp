#include "sysid/structure/structure_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/fitting/score.h"

namespace softgrip::sysid {
namespace {

/// Lower limit of the instantaneous elastic gain, as a share of (displacement range / largest pressure).
constexpr double least_elastic_share = 0.01;
/// Ratio of consecutive time constants of the creep branches.
constexpr double ladder_ratio = 3;
/// Limits of linear modes: shortest period in sampling intervals (the Nyquist period is 2), and longest
/// period in units of time_unit_s().
constexpr double shortest_mode_in_intervals = 4, longest_mode_in_units = 10;

}  // namespace

double least_elastic_mm_per_kpa(const StructureGrid& grid) {
  return least_elastic_share * grid.span_mm / grid.largest_kpa;
}

double longest_mode_s(const StructureGrid& grid) {
  return std::min(longest_mode_in_units * grid.time_unit_s, 1e6);  // 1e6 s: limit of the block
}

StructureGrid grid_for(const std::vector<Record>& records) {
  StructureGrid grid;
  grid.time_unit_s = time_unit_s(records);
  grid.shortest_period_s = std::numeric_limits<double>::infinity();
  double longest_s = 0;
  std::size_t cycles = 0;
  for (const Record& record : records) {
    grid.shortest_period_s =
        std::min(grid.shortest_period_s, shortest_mode_in_intervals * record.mean_interval_s());
    grid.largest_kpa = std::max(grid.largest_kpa, record.largest_kpa);
    grid.span_mm = std::max(grid.span_mm, record.span_mm);
    longest_s = std::max(longest_s, record.length_s());
    cycles += cycle_starts(record).size();
  }
  const int plays = cycles > 2 ? 12 : 6;
  for (int i = 1; i <= plays; ++i)
    grid.thresholds_kpa.push_back(0.95 * std::pow(static_cast<double>(i) / plays, 1.5) * grid.largest_kpa);
  for (double tau = 0.05 * grid.time_unit_s; tau < 3 * longest_s && grid.ladder_s.size() < 10;
       tau *= ladder_ratio)
    grid.ladder_s.push_back(tau);
  grid.slow_from_s = longest_s / 10;
  grid.hinges_kpa = {0.25 * grid.largest_kpa, 0.5 * grid.largest_kpa, 0.75 * grid.largest_kpa};
  for (double tau = 0.25 * grid.time_unit_s; tau < longest_s && grid.hinge_ladder_s.size() < 5; tau *= 5)
    grid.hinge_ladder_s.push_back(tau);
  return grid;
}

}  // namespace softgrip::sysid
