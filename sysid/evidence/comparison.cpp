#include "sysid/evidence/comparison.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "sysid/limits/limits.h"

namespace softgrip::sysid {

Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed) {
  constexpr std::size_t draws = limits::bootstrap_draws;
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> weight(1);
  std::vector<double> differences(draws);
  for (double& difference : differences) {
    double sum = 0, rows = 0;
    for (std::size_t i = 0; i < losses.rows.size(); ++i) {
      const double w = weight(random);
      sum += w * (losses.worse[i] - losses.better[i]);
      rows += w * losses.rows[i];
    }
    difference = rows > 0 ? sum / rows : 0;
  }
  std::sort(differences.begin(), differences.end());
  const auto wins = differences.end() - std::upper_bound(differences.begin(), differences.end(), tolerance);
  const auto at = [&](double share) {
    return differences[static_cast<std::size_t>(share * static_cast<double>(draws - 1))];
  };
  return {static_cast<double>(wins) / static_cast<double>(draws), at((1 - limits::probability) / 2),
          at((1 + limits::probability) / 2)};
}

bool is_better(const Comparison& comparison) {
  return comparison.share >= limits::probability;
}

}  // namespace softgrip::sysid
