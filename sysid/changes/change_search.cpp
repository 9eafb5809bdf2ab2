#include "sysid/changes/change_search.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

double beyond_usual(const ScoredEffect& scored) {
  return scored.gain - scored.usual;
}

/// Returns two counts: the parameters that determine the shape of an effect, and all parameters of the
/// effect.
std::pair<std::size_t, std::size_t> numbers_of(const ScoredEffect& scored) {
  const Effect& effect = scored.fit.fitted.effect;
  return {effect.numbers.size() - effect.nuisance_numbers, effect.numbers.size()};
}

}  // namespace

void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked, const Ties& ties) {
  if (ranked.empty()) return;
  std::vector<std::size_t> tied{0};
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    if (ties(ranked.front(), ranked[i])) tied.push_back(i);
  }
  const auto key = [&](std::size_t i) {
    return std::tuple_cat(numbers_of(ranked[i]), std::tuple(ranked[i].fit.fitted.effect.is_ideal));
  };
  const std::size_t fewest = *std::min_element(tied.begin(), tied.end(),
                                               [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  const auto chosen = ranked.begin() + static_cast<std::ptrdiff_t>(fewest);
  std::rotate(ranked.begin(), chosen, chosen + 1);
}

Ties ties_in(const LaterReadings& readings, std::uint64_t seed) {
  return [&readings, seed](const ScoredEffect& best, const ScoredEffect& other) {
    const Effect& effect = best.fit.fitted.effect;
    const Effect& another = other.fit.fitted.effect;
    if (another.id == effect.indistinguishable) return true;
    const double dearer = price_per_row(readings, effect) - price_per_row(readings, another);
    return !is_better(
        compare(paired_losses(readings, other.fit.white, best.fit.white), best.tolerance + dearer, seed));
  };
}

double price_per_row(const LaterReadings& readings, const Effect& effect) {
  return price_of(effect) / static_cast<double>(std::max<std::size_t>(1, readings.rows().rows().size()));
}

std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings, std::vector<Effect> effects,
                                         const std::vector<FittedEffect>& others, const Tolerance& tolerance,
                                         unsigned threads) {
  for (const FittedEffect& other : others)
    std::erase_if(effects, [&](const Effect& effect) { return effect.id == other.effect.id; });
  const Eigen::VectorXd without = readings.white(others);
  const double before = without.squaredNorm();
  const auto rows = static_cast<double>(std::max<std::size_t>(1, readings.rows().rows().size()));
  std::vector<ScoredEffect> all(effects.size());
  parallel_for(effects.size(), threads, [&](std::size_t i) {
    all[i].fit = fit_effect(readings, effects[i], others, without);
    all[i].gain = (before - all[i].fit.sum_of_squares - price_of(effects[i])) / rows;
    all[i].usual = tolerance.usual(effects[i].id);
    all[i].tolerance = tolerance.of(effects[i].id);
  });
  std::stable_sort(all.begin(), all.end(), [](const ScoredEffect& a, const ScoredEffect& b) {
    return beyond_usual(a) > beyond_usual(b);
  });
  const Ties ties = ties_in(readings, 1);
  std::vector<ScoredEffect> kept;
  while (!all.empty()) {
    const std::string id = all.front().fit.fitted.effect.id;
    const auto rest = std::stable_partition(
        all.begin(), all.end(), [&](const ScoredEffect& each) { return each.fit.fitted.effect.id == id; });
    std::vector<ScoredEffect> forms(std::make_move_iterator(all.begin()), std::make_move_iterator(rest));
    all.erase(all.begin(), rest);
    put_fewest_numbers_first(forms, ties);
    kept.push_back(std::move(forms.front()));
  }
  return kept;
}

std::vector<std::size_t> blocks_of(const LaterReadings& readings) {
  const auto per_block =
      static_cast<std::size_t>(std::max(1.0, readings.base().units.block_s() / readings.base().bin_s));
  std::vector<std::size_t> blocks;
  const std::vector<WhiteRows::Row>& rows = readings.rows().rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool same = i > 0 && rows[i].record == rows[i - 1].record &&
                      rows[i].bin / per_block == rows[i - 1].bin / per_block;
    blocks.push_back(i == 0 ? 0 : blocks.back() + (same ? 0 : 1));
  }
  return blocks;
}

PairedLosses paired_losses(const LaterReadings& readings, const Eigen::VectorXd& worse,
                           const Eigen::VectorXd& better, const std::vector<bool>* rows) {
  const std::vector<std::size_t> blocks = blocks_of(readings);
  PairedLosses losses;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i == 0 || blocks[i] != blocks[i - 1]) losses.begin_block();
    if (rows != nullptr && !(*rows)[i]) continue;
    losses.add(worse(static_cast<Eigen::Index>(i)), better(static_cast<Eigen::Index>(i)));
  }
  return losses;
}

}  // namespace softgrip::sysid
