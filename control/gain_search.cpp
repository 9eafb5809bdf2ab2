#include "control/gain_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace softgrip::control {
namespace {

using Point = std::array<double, 3>;  // ln kp, ln ki, kd
using Corner = std::pair<double, Point>;
using Simplex = std::array<Corner, 4>;

PidSettings gains_at(const Point& x) {
  PidSettings pid;
  pid.kp_kpa_per_mm = std::exp(x[0]);
  pid.ki_kpa_per_mm_s = std::exp(x[1]);
  pid.kd_kpa_s_per_mm = std::max(0.0, x[2]);
  return pid;
}

Point along(const Point& from, const Point& to, double t) {
  Point result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = from[i] + t * (to[i] - from[i]);
  return result;
}

Point centre_of_best(const Simplex& simplex) {
  Point centre{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) centre[j] += simplex[i].second[j] / 3;
  }
  return centre;
}

template <class Cost>
void iterate(Simplex& simplex, const Cost& cost) {
  std::sort(simplex.begin(), simplex.end());
  const Point centre = centre_of_best(simplex);
  const Point worst = simplex[3].second;
  const auto tried = [&](double t) {
    const Point point = along(centre, worst, t);
    return Corner{cost(point), point};
  };
  const Corner mirrored = tried(-1);
  if (mirrored.first < simplex[0].first) {
    simplex[3] = std::min(tried(-2), mirrored);
    return;
  }
  if (mirrored.first < simplex[2].first) {
    simplex[3] = mirrored;
    return;
  }
  const Corner nearer = tried(mirrored.first < simplex[3].first ? -0.5 : 0.5);
  if (nearer.first < std::min(mirrored.first, simplex[3].first)) {
    simplex[3] = nearer;
    return;
  }
  for (std::size_t i = 1; i < simplex.size(); ++i) {
    const Point point = along(simplex[0].second, simplex[i].second, 0.5);
    simplex[i] = {cost(point), point};
  }
}

}  // namespace

PidSettings search_gains(const std::function<double(const PidSettings&)>& cost, const GainSearch& search) {
  const auto cost_at = [&](const Point& x) { return cost(gains_at(x)); };
  Corner best{std::numeric_limits<double>::infinity(), {}};
  int index = 0;
  for (const double kp : {0.02, 0.1, 0.3, 0.8, 2.0}) {
    for (const double ki : {0.1, 0.5, 1.5, 3.0, 6.0, 12.0}) {
      if (index++ % std::max(1, search.coarseness) != 0) continue;
      const Point point{std::log(kp), std::log(ki), 0};
      best = std::min(best, Corner{cost_at(point), point});
    }
  }
  Simplex simplex;
  simplex.fill(best);
  for (std::size_t i = 0; i < 3; ++i) {
    Point point = best.second;
    point[i] += i == 2 ? 0.02 : 0.4;
    simplex[i + 1] = {cost_at(point), point};
  }
  for (int k = 0; k < search.iterations; ++k) iterate(simplex, cost_at);
  return gains_at(std::min_element(simplex.begin(), simplex.end())->second);
}

}  // namespace softgrip::control
