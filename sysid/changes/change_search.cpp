#include "sysid/changes/change_search.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/parallel.h"

namespace softgrip::sysid {
namespace {

constexpr double price_of_a_number = 8;
/// A base is not so certain of a course that it never saw that a smaller share of what a cause takes would
/// tell it from one that it contains.
constexpr double alike_share = 0.01;
constexpr double block_s = 5;
constexpr int draws = 500;

double beyond_chance(const ScoredEffect& scored) {
  return scored.gain - scored.chance;
}

/// A line that fills and empties alike is a lag of the valve: what the first contains goes before it where
/// it takes as much.
void contained_first(std::vector<ScoredEffect>& ranked) {
  if (ranked.empty() || !(beyond_chance(ranked.front()) > 0)) return;
  const double least = (1 - alike_share) * beyond_chance(ranked.front());
  const auto contained = std::find_if(ranked.begin(), ranked.end(), [&](const ScoredEffect& each) {
    return each.fit.fitted.effect.id == ranked.front().fit.fitted.effect.contains &&
           beyond_chance(each) >= least;
  });
  if (contained != ranked.end()) std::rotate(ranked.begin(), contained, contained + 1);
}

}  // namespace

double price_of(const Effect& effect) {
  return price_of_a_number * static_cast<double>(effect.numbers.size());
}

std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings, const std::vector<Effect>& effects,
                                         const std::vector<FittedEffect>& others, const Chance& chance,
                                         unsigned threads) {
  const Eigen::VectorXd without = readings.white(others);
  const double before = without.squaredNorm();
  const auto rows = static_cast<double>(std::max<std::size_t>(1, readings.rows().rows().size()));
  std::vector<ScoredEffect> all(effects.size());
  parallel_for(effects.size(), threads, [&](std::size_t i) {
    all[i].fit = fit_effect(readings, effects[i], others, without);
    all[i].gain = (before - all[i].fit.sum_of_squares - price_of(effects[i])) / rows;
    const auto known = chance.find(effects[i].id);
    all[i].chance = known == chance.end() ? 0 : known->second;
  });
  std::stable_sort(all.begin(), all.end(), [](const ScoredEffect& a, const ScoredEffect& b) {
    return beyond_chance(a) > beyond_chance(b);
  });
  std::vector<ScoredEffect> kept;
  for (ScoredEffect& each : all) {
    const bool there = std::any_of(kept.begin(), kept.end(), [&](const ScoredEffect& k) {
      return k.fit.fitted.effect.id == each.fit.fitted.effect.id;
    });
    if (!there) kept.push_back(std::move(each));
  }
  contained_first(kept);
  return kept;
}

std::vector<double> block_sums(const LaterReadings& readings, const Eigen::VectorXd& white) {
  const auto per_block = static_cast<std::size_t>(std::max(1.0, block_s / readings.base().bin_s));
  std::vector<double> sums;
  std::size_t last_record = 0, last_block = 0;
  const std::vector<WhiteRows::Row>& rows = readings.rows().rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t block = rows[i].bin / per_block;
    if (sums.empty() || rows[i].record != last_record || block != last_block) sums.push_back(0);
    last_record = rows[i].record;
    last_block = block;
    sums.back() += std::pow(white(static_cast<Eigen::Index>(i)), 2);
  }
  return sums;
}

Resampled resampled(const std::vector<double>& worse, const std::vector<double>& better, std::uint64_t seed,
                    double dearer) {
  std::mt19937_64 random(seed * 7919 + 3);
  std::uniform_int_distribution<std::size_t> pick(0, worse.size() - 1);
  std::vector<double> totals;
  for (int d = 0; d < draws; ++d) {
    double total = dearer;
    for (std::size_t i = 0; i < worse.size(); ++i) {
      const std::size_t b = pick(random);
      total += worse[b] - better[b];
    }
    totals.push_back(total);
  }
  std::sort(totals.begin(), totals.end());
  Resampled result;
  result.share =
      static_cast<double>(std::count_if(totals.begin(), totals.end(), [](double t) { return t > 0; })) /
      draws;
  result.lower = totals[static_cast<std::size_t>(0.025 * draws)];
  result.upper = totals[static_cast<std::size_t>(0.975 * draws)];
  return result;
}

}  // namespace softgrip::sysid
