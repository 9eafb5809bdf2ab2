#include "sysid/evidence/comparison.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

double reduction_of(double worse, double better) {
  return worse > 0 ? 1 - std::sqrt(better / worse) : 0;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

void PairedLosses::begin_block() {
  for (std::vector<double>* const list : {&worse, &better, &rows}) list->push_back(0);
}

void PairedLosses::add(double residual_of_worse, double residual_of_better) {
  worse.back() += square(residual_of_worse);
  better.back() += square(residual_of_better);
  rows.back() += 1;
}

void PairedLosses::append(const PairedLosses& more) {
  worse.insert(worse.end(), more.worse.begin(), more.worse.end());
  better.insert(better.end(), more.better.begin(), more.better.end());
  rows.insert(rows.end(), more.rows.begin(), more.rows.end());
}

Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed) {
  constexpr std::size_t draws = limits::bootstrap_draws;
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> weight(1);
  std::vector<double> differences(draws), reductions(draws);
  for (std::size_t draw = 0; draw < draws; ++draw) {
    double worse = 0, better = 0, rows = 0;
    for (std::size_t i = 0; i < losses.rows.size(); ++i) {
      const double w = weight(random);
      worse += w * losses.worse[i];
      better += w * losses.better[i];
      rows += w * losses.rows[i];
    }
    differences[draw] = rows > 0 ? (worse - better) / rows : 0;
    reductions[draw] = reduction_of(worse, better);
  }
  std::sort(differences.begin(), differences.end());
  std::sort(reductions.begin(), reductions.end());
  const auto wins = differences.end() - std::upper_bound(differences.begin(), differences.end(), tolerance);
  const auto low = static_cast<std::size_t>((1 - limits::probability) / 2 * static_cast<double>(draws - 1));
  const auto high = static_cast<std::size_t>((1 + limits::probability) / 2 * static_cast<double>(draws - 1));
  return {static_cast<double>(wins) / static_cast<double>(draws),    differences[low], differences[high],
          reduction_of(sum_of(losses.worse), sum_of(losses.better)), reductions[low],  reductions[high]};
}

bool is_better(const Comparison& comparison) {
  return comparison.share >= limits::probability;
}

double run_to_run_factor(std::size_t runs) {
  constexpr double directions = limits::run_directions;
  if (runs < 2) return f_quantile(limits::probability, directions, directions);
  const auto n = static_cast<double>(runs);
  return f_quantile(limits::probability, directions, directions * (n - 1)) * (1 - 1 / (n * n));
}

Tolerance::Tolerance(const std::vector<NullGains>& units, std::size_t runs, double more)
    : factor_(run_to_run_factor(runs)), more_(more) {
  for (const NullGains& unit : units) {
    for (const auto& [cause, gain] : unit)
      usual_[cause] += std::max(gain, 0.0) / static_cast<double>(units.size());
  }
  for (const auto& [cause, gain] : usual_) average_ += gain / static_cast<double>(usual_.size());
}

double Tolerance::usual(std::string_view cause) const {
  const auto found = usual_.find(cause);
  return found == usual_.end() ? average_ : found->second;
}

double Tolerance::of(std::string_view cause) const {
  return factor_ * (std::max(usual(cause), average_) + more_);
}

}  // namespace softgrip::sysid
