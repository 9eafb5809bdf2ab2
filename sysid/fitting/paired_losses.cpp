#include "sysid/fitting/paired_losses.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t draws = limits::bootstrap_draws;

Spread spread_of(std::size_t blocks, std::uint64_t seed, const BlockStatistic& statistic) {
  std::vector<std::size_t> indices(blocks);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  Spread spread;
  spread.value = statistic(indices);
  std::vector<double> values = statistic_of_draws(blocks, draws, seed, statistic);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / draws;
  double square = 0;
  for (const double value : values) square += (value - mean) * (value - mean);
  spread.standard_error = std::sqrt(square / draws);
  std::sort(values.begin(), values.end());
  spread.lower = values[static_cast<std::size_t>((1 - limits::probability) / 2 * draws)];
  spread.upper = values[static_cast<std::size_t>((1 + limits::probability) / 2 * draws)];
  return spread;
}

}  // namespace

std::vector<double> statistic_of_draws(std::size_t blocks, std::size_t count, std::uint64_t seed,
                                       const BlockStatistic& statistic) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, blocks - 1);
  std::vector<std::size_t> indices(blocks);
  std::vector<double> values(count);
  for (double& value : values) {
    for (std::size_t& index : indices) index = pick(random);
    value = statistic(indices);
  }
  return values;
}

Spread mean_difference(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed) {
  return spread_of(worse.size(), seed, [&](std::span<const std::size_t> indices) {
    double sum = 0;
    for (const std::size_t i : indices) sum += worse[i] - better[i];
    return sum / static_cast<double>(indices.size());
  });
}

bool is_missed(const BlockLosses& without, const BlockLosses& with, double least_mm2, std::uint64_t seed) {
  const Spread missed = mean_difference(without, with, seed);
  return missed.lower > 0 && missed.value > least_mm2;
}

Spread mean_log_ratio(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed) {
  return spread_of(worse.size(), seed, [&](std::span<const std::size_t> indices) {
    double sum = 0;
    for (const std::size_t i : indices)
      sum += worse[i] > 0 && better[i] > 0 ? std::log(worse[i] / better[i]) : 0;
    return sum / static_cast<double>(indices.size());
  });
}

Spread gain_percent(const BlockLosses& before, const BlockLosses& after, std::uint64_t seed) {
  return spread_of(before.size(), seed, [&](std::span<const std::size_t> indices) {
    double old_sum = 0, new_sum = 0;
    for (const std::size_t i : indices) {
      old_sum += before[i];
      new_sum += after[i];
    }
    return old_sum > 0 ? 100 * (1 - std::sqrt(new_sum / old_sum)) : 0.0;
  });
}

double winning_share(const BlockLosses& ours, const BlockLosses& other, std::uint64_t seed) {
  const auto ahead = statistic_of_draws(ours.size(), draws, seed, [&](std::span<const std::size_t> indices) {
    double sum = 0;
    for (const std::size_t i : indices) sum += other[i] - ours[i];
    return sum;
  });
  double won = 0;
  for (const double sum : ahead) won += sum > 0 ? 1 : sum == 0 ? 0.5 : 0;
  return won / static_cast<double>(draws);
}

double rmse_mm(const BlockLosses& losses) {
  if (losses.empty()) return 0;
  return std::sqrt(std::accumulate(losses.begin(), losses.end(), 0.0) / static_cast<double>(losses.size()));
}

LossDifference loss_difference(const BlockLosses& worse, const BlockLosses& better) {
  const auto n = static_cast<double>(worse.size());
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < worse.size(); ++i) mean += (worse[i] - better[i]) / n;
  for (std::size_t i = 0; i < worse.size(); ++i) square += std::pow(worse[i] - better[i] - mean, 2) / (n - 1);
  return {mean, std::sqrt(square / n)};
}

bool is_clearly_less(const BlockLosses& better, const BlockLosses& worse) {
  const LossDifference plain = loss_difference(worse, better);
  if (!(plain.mean_mm2 > 0)) return false;
  if (plain.mean_mm2 > limits::deviate * plain.standard_error_mm2) return true;
  const auto logarithms = [](BlockLosses losses) {
    for (double& loss : losses) loss = std::log(std::max(loss, 1e-300));
    return losses;
  };
  const LossDifference by_ratio = loss_difference(logarithms(worse), logarithms(better));
  return by_ratio.mean_mm2 > limits::deviate * by_ratio.standard_error_mm2;
}

}  // namespace softgrip::sysid
