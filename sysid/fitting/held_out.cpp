#include "sysid/fitting/held_out.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/each_record.h"

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

/// Returns the mean over the blocks.
/// @param value  function that returns the value of a block.
template <class Value>
Spread mean_over_blocks(std::size_t blocks, std::uint64_t seed, Value value) {
  return spread_of(blocks, seed, [&](std::span<const std::size_t> indices) {
    double sum = 0;
    for (const std::size_t i : indices) sum += value(i);
    return sum / static_cast<double>(indices.size());
  });
}

bool is_finite_where_read(const Record& record, const std::vector<double>& residual_mm, const Block& block) {
  for (std::size_t i = block.first; i < block.last; ++i) {
    if (std::isfinite(record.reading_mm[i]) && !std::isfinite(residual_mm[i])) return false;
  }
  return true;
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
  return mean_over_blocks(worse.size(), seed, [&](std::size_t i) { return worse[i] - better[i]; });
}

bool is_missed(const BlockLosses& without, const BlockLosses& with, double least_mm2, std::uint64_t seed) {
  const Spread missed = mean_difference(without, with, seed);
  return missed.lower > 0 && missed.value > least_mm2;
}

Spread mean_log_ratio(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed) {
  return mean_over_blocks(worse.size(), seed, [&](std::size_t i) {
    return worse[i] > 0 && better[i] > 0 ? std::log(worse[i] / better[i]) : 0;
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

double loss_of(const std::vector<double>& residual_mm, const Block& block) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = block.first; i < block.last; ++i) {
    if (std::isnan(residual_mm[i])) continue;
    sum += residual_mm[i] * residual_mm[i];
    ++count;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                            const Refit& refit) {
  BlockLosses losses(division.blocks.size(), 0.0);
  parallel_for_idle(division.folds, [&](std::size_t fold) {
    const FitPoint point = refit(without_fold(records, division, fold));
    std::vector<std::vector<double>> residual_mm(records.size());
    for_each_record(records, [&](std::size_t k) {
      residual_mm[k] = residual(records[k], predict(point.model, records[k], point.starts[k]));
    });
    for (std::size_t b = 0; b < losses.size(); ++b) {
      const Block& block = division.blocks[b];
      if (block.fold != fold) continue;
      const double most = square(records[block.record].span_mm);
      const bool is_predicted = is_finite_where_read(records[block.record], residual_mm[block.record], block);
      losses[b] = is_predicted ? std::min(loss_of(residual_mm[block.record], block), most) : most;
    }
  });
  return losses;
}

}  // namespace softgrip::sysid
