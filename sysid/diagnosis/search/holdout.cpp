#include "sysid/diagnosis/search/holdout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/parallel.h"

namespace softgrip::sysid {
namespace {

/// The state in which a log begins is no part of the model's structure: without the first block it could not
/// be told, and the rest would be simulated from anywhere.
constexpr FitEffort refit{.most_iterations = 8, .tolerance = 1e-6, .hold_starts = true};
constexpr std::size_t draws = 1000;
constexpr std::size_t fewest_blocks = 8;
/// With fewer blocks than this a half of them does not determine a model: quarters are held out instead.
constexpr std::size_t enough_to_halve = 16;

std::vector<Record> hidden(const std::vector<Record>& records, const Division& division, std::size_t fold) {
  std::vector<Record> rest = records;
  for (const Block& block : division.blocks) {
    if (block.fold != fold) continue;
    Record& record = rest[block.record];
    const double from = record.time_s[block.first] - division.gap_s;
    const double to = record.time_s[block.last - 1] + division.gap_s;
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (record.time_s[i] >= from && record.time_s[i] <= to)
        record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  for (Record& record : rest) {
    record.readings = static_cast<std::size_t>(std::count_if(
        record.reading_mm.begin(), record.reading_mm.end(), [](double y) { return std::isfinite(y); }));
  }
  return rest;
}

double loss(const std::vector<double>& residual_mm, const Block& block) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = block.first; i < block.last; ++i) {
    if (std::isnan(residual_mm[i])) continue;
    sum += residual_mm[i] * residual_mm[i];
    ++count;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

/// Statistics of resampled blocks: calls sample(indices) `draws` times.
template <class Statistic>
Spread bootstrap(std::size_t blocks, std::uint64_t seed, Statistic&& statistic) {
  std::vector<std::size_t> indices(blocks);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  Spread spread;
  spread.value = statistic(indices);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, blocks - 1);
  std::vector<double> values(draws);
  for (double& value : values) {
    for (std::size_t& index : indices) index = pick(random);
    value = statistic(indices);
  }
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / draws;
  double square = 0;
  for (const double value : values) square += (value - mean) * (value - mean);
  spread.standard_error = std::sqrt(square / draws);
  std::sort(values.begin(), values.end());
  spread.lower = values[static_cast<std::size_t>(0.025 * draws)];
  spread.upper = values[static_cast<std::size_t>(0.975 * draws)];
  return spread;
}

}  // namespace

Division divide(const std::vector<Record>& records, double block_s) {
  double length_s = 0;
  for (const Record& record : records) length_s += record.length_s();
  const double wanted_s = std::min(block_s, length_s / fewest_blocks);
  Division division;
  division.gap_s = 0.1 * wanted_s;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Record& record = records[k];
    const double record_s = record.length_s();
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(record_s / wanted_s)));
    std::size_t first = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      const double end_s =
          record.time_s.front() + record_s * static_cast<double>(part + 1) / static_cast<double>(parts);
      std::size_t last = first;
      while (last < record.size() && (record.time_s[last] < end_s || part + 1 == parts)) ++last;
      if (last > first) division.blocks.push_back({k, first, last, 0});
      first = last;
    }
  }
  division.folds = division.blocks.size() < enough_to_halve ? 4 : 2;
  for (std::size_t b = 0; b < division.blocks.size(); ++b) division.blocks[b].fold = b % division.folds;
  return division;
}

Division thinned_like(Division division, const std::vector<Record>& records,
                      const std::vector<Record>& thinned) {
  for (Block& block : division.blocks) {
    const std::vector<double>& all = records[block.record].time_s;
    const std::vector<double>& left = thinned[block.record].time_s;
    const auto index_of = [&](std::size_t sample) {
      if (sample >= all.size()) return left.size();
      return static_cast<std::size_t>(std::lower_bound(left.begin(), left.end(), all[sample]) - left.begin());
    };
    block.first = index_of(block.first);
    block.last = index_of(block.last);
  }
  return division;
}

Division divide_by_record(const std::vector<Record>& records) {
  Division division;
  division.folds = records.size();
  for (std::size_t k = 0; k < records.size(); ++k) division.blocks.push_back({k, 0, records[k].size(), k});
  return division;
}

BlockLosses losses_of(const StructureFit& fit, const Division& division) {
  BlockLosses losses;
  for (const Block& block : division.blocks) losses.push_back(loss(fit.residual_mm[block.record], block));
  return losses;
}

BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                            const StructureFit& fit) {
  BlockLosses losses(division.blocks.size(), 0.0);
  parallel_for_idle(division.folds, [&](std::size_t fold) {
    const std::vector<Record> rest = hidden(records, division, fold);
    const StructureFit without = fit_structure(rest, fit.causes, fit.point, refit);
    const StructureFit judged = evaluate_structure(records, fit.causes, without.point);
    for (std::size_t b = 0; b < losses.size(); ++b) {
      const Block& block = division.blocks[b];
      if (block.fold != fold) continue;
      const double span_mm = records[block.record].span_mm;
      losses[b] = std::min(loss(judged.residual_mm[block.record], block), span_mm * span_mm);
    }
  });
  return losses;
}

Spread mean_difference(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed) {
  return bootstrap(worse.size(), seed, [&](const std::vector<std::size_t>& indices) {
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
  return bootstrap(worse.size(), seed, [&](const std::vector<std::size_t>& indices) {
    double sum = 0;
    for (const std::size_t i : indices)
      sum += worse[i] > 0 && better[i] > 0 ? std::log(worse[i] / better[i]) : 0;
    return sum / static_cast<double>(indices.size());
  });
}

Spread gain_percent(const BlockLosses& before, const BlockLosses& after, std::uint64_t seed) {
  return bootstrap(before.size(), seed, [&](const std::vector<std::size_t>& indices) {
    double old_sum = 0, new_sum = 0;
    for (const std::size_t i : indices) {
      old_sum += before[i];
      new_sum += after[i];
    }
    return old_sum > 0 ? 100 * (1 - std::sqrt(new_sum / old_sum)) : 0.0;
  });
}

double winning_share(const BlockLosses& ours, const BlockLosses& other, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, ours.size() - 1);
  double won = 0;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    double ahead = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const std::size_t block = pick(random);
      ahead += other[block] - ours[block];
    }
    won += ahead > 0 ? 1 : ahead == 0 ? 0.5 : 0;
  }
  return won / static_cast<double>(draws);
}

double rmse_mm(const BlockLosses& losses) {
  if (losses.empty()) return 0;
  return std::sqrt(std::accumulate(losses.begin(), losses.end(), 0.0) / static_cast<double>(losses.size()));
}

}  // namespace softgrip::sysid
