#include "sysid/evidence/comparison.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Calls `use` with the weights of the blocks in each sample of a Bayesian bootstrap.
template <class Use>
void for_each_sample(std::size_t blocks, std::uint64_t seed, Use use) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> exponential(1);
  std::vector<double> weights(blocks);
  for (std::size_t sample = 0; sample < limits::bootstrap_draws; ++sample) {
    for (double& weight : weights) weight = exponential(random);
    use(weights);
  }
}

/// Returns the 95 % interval of sorted values.
Interval interval_of(const std::vector<double>& sorted) {
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  return {at((1 - limits::probability) / 2), at((1 + limits::probability) / 2)};
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
  std::vector<double> differences;
  for_each_sample(losses.rows.size(), seed, [&](const std::vector<double>& weights) {
    double sum = 0, rows = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      sum += weights[i] * (losses.worse[i] - losses.better[i]);
      rows += weights[i] * losses.rows[i];
    }
    differences.push_back(rows > 0 ? sum / rows : 0);
  });
  std::sort(differences.begin(), differences.end());
  const auto wins = differences.end() - std::upper_bound(differences.begin(), differences.end(), tolerance);
  const Interval interval = interval_of(differences);
  return {static_cast<double>(wins) / static_cast<double>(differences.size()), interval.lower,
          interval.upper};
}

ErrorReduction error_reduction(const PairedLosses& losses, std::uint64_t seed) {
  const auto with = [&](const std::vector<double>& weights) {
    const double worse = std::inner_product(weights.begin(), weights.end(), losses.worse.begin(), 0.0);
    const double better = std::inner_product(weights.begin(), weights.end(), losses.better.begin(), 0.0);
    return worse > 0 ? 1 - std::sqrt(better / worse) : 0;
  };
  std::vector<double> reductions;
  for_each_sample(losses.rows.size(), seed,
                  [&](const std::vector<double>& weights) { reductions.push_back(with(weights)); });
  std::sort(reductions.begin(), reductions.end());
  return {with(std::vector<double>(losses.rows.size(), 1)), interval_of(reductions)};
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
