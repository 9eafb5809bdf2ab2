#include "control/tuning/gain_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softgrip::control {
namespace {

using Corner = std::pair<double, GainPoint>;
using Corners = std::array<Corner, 4>;

PidSettings gains_at(const GainPoint& x) {
  PidSettings pid;
  pid.kp_kpa_per_mm = std::exp(x[0]);
  pid.ki_kpa_per_mm_s = std::exp(x[1]);
  pid.kd_kpa_s_per_mm = std::max(0.0, x[2]);
  return pid;
}

GainPoint along(const GainPoint& from, const GainPoint& to, double share) {
  GainPoint result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = from[i] + share * (to[i] - from[i]);
  return result;
}

GainPoint centre_of_best(const Corners& corners) {
  GainPoint centre{};
  for (std::size_t i = 0; i < centre.size(); ++i) {
    centre[i] = (corners[0].second[i] + corners[1].second[i] + corners[2].second[i]) / 3;
  }
  return centre;
}

/// Performs one step of the simplex method. The step replaces the corner with the highest cost, or moves all
/// corners towards the corner with the lowest cost.
void move_worst(Corners& corners, const std::function<double(const GainPoint&)>& cost) {
  const GainPoint centre = centre_of_best(corners);
  const GainPoint worst = corners[3].second;
  const auto tried = [&](double share) {
    const GainPoint point = along(centre, worst, share);
    return Corner{cost(point), point};
  };
  const Corner mirrored = tried(-1);
  if (mirrored.first < corners[0].first) {
    corners[3] = std::min(tried(-2), mirrored);
    return;
  }
  if (mirrored.first < corners[2].first) {
    corners[3] = mirrored;
    return;
  }
  const Corner nearer = tried(mirrored.first < corners[3].first ? -0.5 : 0.5);
  if (nearer.first < std::min(mirrored.first, corners[3].first)) {
    corners[3] = nearer;
    return;
  }
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const GainPoint point = along(corners[0].second, corners[i].second, 0.5);
    corners[i] = {cost(point), point};
  }
}

}  // namespace

GainPoint nelder_mead(const std::function<double(const GainPoint&)>& cost, const GainPoint& start,
                      double cost_at_start, const Simplex& simplex) {
  Corners corners;
  corners.fill({cost_at_start, start});
  for (std::size_t i = 0; i < simplex.edges.size(); ++i) {
    GainPoint point = start;
    point[i] += simplex.edges[i];
    corners[i + 1] = {cost(point), point};
  }
  for (int k = 0; k < simplex.iterations; ++k) {
    std::sort(corners.begin(), corners.end());
    if (corners[3].first - corners[0].first < simplex.done_share * corners[0].first) break;
    move_worst(corners, cost);
  }
  return std::min_element(corners.begin(), corners.end())->second;
}

PidSettings search_gains(const std::function<double(const PidSettings&)>& cost, const GainSearch& search) {
  const auto cost_at = [&](const GainPoint& x) { return cost(gains_at(x)); };
  Corner best{std::numeric_limits<double>::infinity(), {}};
  int index = 0;
  for (const double kp : {0.02, 0.1, 0.3, 0.8, 2.0}) {
    for (const double ki : {0.1, 0.5, 1.5, 3.0, 6.0, 12.0}) {
      if (index++ % std::max(1, search.coarseness) != 0) continue;
      const GainPoint point{std::log(kp), std::log(ki), 0};
      best = std::min(best, Corner{cost_at(point), point});
    }
  }
  return gains_at(nelder_mead(cost_at, best.second, best.first, {.iterations = search.iterations}));
}

}  // namespace softgrip::control
