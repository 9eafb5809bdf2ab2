#include "sysid/logs/isolated_values.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/numbers.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t fewest_neighbours = 2;  // on each side

double neighbours_median(const std::vector<double>& y, std::size_t i) {
  std::array<double, 4> near{y[i - 2], y[i - 1], y[i + 1], y[i + 2]};
  std::sort(near.begin(), near.end());
  return 0.5 * (near[1] + near[2]);
}

/// Returns the change from the two values before index i to the two values after it. In a fast motion, this
/// change alone makes a value deviate from its neighbours. The value then is not isolated.
double motion(const std::vector<double>& y, std::size_t i) {
  return std::abs(0.5 * (y[i + 1] + y[i + 2]) - 0.5 * (y[i - 1] + y[i - 2]));
}

}  // namespace

Neighbourhood neighbourhood(const std::vector<double>& r, std::size_t i) {
  constexpr std::size_t reach = isolated_reach;
  std::array<double, 2 * reach> near{};
  std::size_t count = 0, before = 0;
  for (std::size_t j = i < reach ? 0 : i - reach; j <= std::min(i + reach, r.size() - 1); ++j) {
    if (j == i || !std::isfinite(r[j])) continue;
    near[count++] = r[j];
    before += j < i ? 1 : 0;
  }
  Neighbourhood n;
  if (before < fewest_neighbours || count - before < fewest_neighbours) return n;
  const auto end = near.begin() + static_cast<long>(count);
  std::sort(near.begin(), end);
  n.median = 0.5 * (near[(count - 1) / 2] + near[count / 2]);
  for (auto at = near.begin(); at != end; ++at) *at = std::abs(*at - n.median);
  std::sort(near.begin(), end);
  n.spread = near[count - 2];
  n.known = true;
  return n;
}

std::vector<IsolatedValue> isolated_values(const std::vector<double>& column, double noise) {
  const auto [samples, values] = finite_values(column);
  std::vector<IsolatedValue> isolated;
  for (std::size_t i = 2; i + 2 < values.size(); ++i) {
    const double distance = values[i] - neighbours_median(values, i);
    if (std::abs(distance) <= isolated_beyond * noise || std::abs(distance) <= 3 * motion(values, i))
      continue;
    const Neighbourhood near = neighbourhood(values, i);
    if (near.known && std::abs(distance) > isolated_alone * near.spread)
      isolated.push_back({samples[i], distance});
  }
  return isolated;
}

double usual_span(const std::vector<double>& column) {
  std::vector<double> sorted = finite_values(column).values;
  if (sorted.empty()) return 0;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() - 1 - sorted.size() / 20] - sorted[sorted.size() / 20];
}

std::string listed(const std::vector<double>& column, const std::vector<double>& time_s,
                   const std::vector<std::size_t>& samples, std::string_view unit) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, samples.size()); ++k)
    text += (k == 0 ? "" : ", ") + significant(column[samples[k]]) + " " + std::string(unit) + " at " +
            significant(time_s[samples[k]], 6) + " s";
  if (samples.size() > most) text += " and " + std::to_string(samples.size() - most) + " more";
  return text;
}

}  // namespace softgrip::sysid
