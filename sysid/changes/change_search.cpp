#include "sysid/changes/change_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <utility>

#include "base/parallel.h"

namespace softgrip::sysid {
namespace {

constexpr double price_of_a_number = 8;
/// A base is not so certain of a course that it never saw that a smaller share of what a cause takes, and of
/// what chance leaves in a bin, would tell it from a simpler one; nor what so many numbers must take.
constexpr double alike_share = 0.01, alike_per_bin = 0.05, alike_numbers = 3;
/// In changed worlds (of --first-seed 20261203) a line that is no lag of the valve takes 4 % more than one,
/// and a lag at most 1.6 % less than a line; a loop that relaxes takes 13 % more than a lag, and that at
/// most 3.3 % less than the loop (20261218).
constexpr double contained_share = 0.025;
constexpr double drawn_block_s = 5;
constexpr int draws = 500;

double beyond_chance(const ScoredEffect& scored) {
  return scored.gain - scored.chance;
}

/// How many numbers shape it, and how many it has.
std::pair<std::size_t, std::size_t> numbers_of(const ScoredEffect& scored) {
  const Effect& effect = scored.fit.fitted.effect;
  return {effect.numbers.size() - effect.slack_numbers, effect.numbers.size()};
}

/// What chance alone sets apart: the gain of a few numbers.
double within_chance(const ScoredEffect& scored) {
  return alike_numbers * scored.worth_of_a_number;
}

/// Of those with as many numbers that chance alone sets apart from an ideal, the first that is none; else it.
std::size_t real_beside(const std::vector<ScoredEffect>& ranked, std::size_t ideal) {
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const bool near = beyond_chance(ranked[i]) >= beyond_chance(ranked[ideal]) - within_chance(ranked[ideal]);
    if (near && !ranked[i].fit.fitted.effect.is_ideal && numbers_of(ranked[i]) == numbers_of(ranked[ideal]))
      return i;
  }
  return ideal;
}

}  // namespace

bool takes_as_much(const ScoredEffect& other, const ScoredEffect& best) {
  const double most = beyond_chance(best), less = most - beyond_chance(other);
  return less <= within_chance(best) || less <= std::min(alike_share * most, alike_per_bin);
}

void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked) {
  if (ranked.empty() || !(beyond_chance(ranked.front()) > 0)) return;
  const FittedEffect& first = ranked.front().fit.fitted;
  std::size_t fewest = 0;
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    const std::string& id = ranked[i].fit.fitted.effect.id;
    const bool contained = id == first.effect.contains &&
                           beyond_chance(ranked[i]) >= (1 - contained_share) * beyond_chance(ranked.front());
    // Where a base is wrong, a cause is as wrong as its limit or its twin: the price of its number decides.
    const bool by_price = id == first.effect.limit || id == first.effect.twin;
    const bool as_much = !by_price && takes_as_much(ranked[i], ranked.front());
    if ((contained || as_much) && numbers_of(ranked[i]) < numbers_of(ranked[fewest])) fewest = i;
  }
  if (ranked[fewest].fit.fitted.effect.is_ideal) fewest = real_beside(ranked, fewest);
  const auto chosen = ranked.begin() + static_cast<std::ptrdiff_t>(fewest);
  std::rotate(ranked.begin(), chosen, chosen + 1);
}

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
    all[i].worth_of_a_number = price_of_a_number / rows;
    all[i].gain = (before - all[i].fit.sum_of_squares - price_of(effects[i])) / rows;
    const auto known = chance.find(effects[i].id);
    all[i].chance = known == chance.end() ? 0 : known->second;
  });
  std::stable_sort(all.begin(), all.end(), [](const ScoredEffect& a, const ScoredEffect& b) {
    return beyond_chance(a) > beyond_chance(b);
  });
  std::vector<ScoredEffect> kept;
  while (!all.empty()) {
    const std::string id = all.front().fit.fitted.effect.id;
    const auto rest = std::stable_partition(
        all.begin(), all.end(), [&](const ScoredEffect& each) { return each.fit.fitted.effect.id == id; });
    std::vector<ScoredEffect> forms(std::make_move_iterator(all.begin()), std::make_move_iterator(rest));
    all.erase(all.begin(), rest);
    put_fewest_numbers_first(forms);
    kept.push_back(std::move(forms.front()));
  }
  return kept;
}

std::vector<std::size_t> blocks_of(const LaterReadings& readings) {
  const auto per_block = static_cast<std::size_t>(std::max(1.0, drawn_block_s / readings.base().bin_s));
  std::vector<std::size_t> blocks;
  const std::vector<WhiteRows::Row>& rows = readings.rows().rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool same = i > 0 && rows[i].record == rows[i - 1].record &&
                      rows[i].bin / per_block == rows[i - 1].bin / per_block;
    blocks.push_back(i == 0 ? 0 : blocks.back() + (same ? 0 : 1));
  }
  return blocks;
}

std::vector<double> block_sums(const LaterReadings& readings, const Eigen::VectorXd& white) {
  const std::vector<std::size_t> blocks = blocks_of(readings);
  std::vector<double> sums(blocks.empty() ? 0 : blocks.back() + 1);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    sums[blocks[i]] += std::pow(white(static_cast<Eigen::Index>(i)), 2);
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
