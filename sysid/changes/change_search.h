#pragma once
// Which effects one reading shows, one after the other, each against what chance shows on healthy logs.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sysid/changes/effect_fit.h"

namespace softgrip::sysid {

struct ScoredEffect {
  EffectFit fit;
  double gain = 0;               ///< whitened squares per row that it takes, less what its numbers cost
  double worth_of_a_number = 0;  ///< what one must take to be worth it, per row
  double chance = 0;             ///< what its cause took of the healthy logs while they were held out
};

/// Of every cause, what its best form takes of healthy logs that were held out: chance, and where the base is
/// wrong.
using Chance = std::map<std::string, double>;

/// What the numbers of an effect must take to be worth it, in whitened squares.
[[nodiscard]] double price_of(const Effect& effect);

/// Whether another effect takes nearly what the best one takes beyond chance: what one base is not certain
/// enough of to tell them apart, however many bins say so.
[[nodiscard]] bool takes_as_much(const ScoredEffect& other, const ScoredEffect& best);

/// What takes most beyond chance first; of every cause one form, that of those which take as much the one
/// with the fewest numbers.
[[nodiscard]] std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings,
                                                       const std::vector<Effect>& effects,
                                                       const std::vector<FittedEffect>& others,
                                                       const Chance& chance, unsigned threads);

/// Of those that take as much as the first, the one with the fewest numbers goes before it: those that shape
/// it are counted before those that only say where it is counted from. A line that fills and empties alike is
/// a lag of the valve, however much they take. A cause's limit and its twin take more, or go behind it.
void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked);

/// Of every row of the readings, which block of some seconds it is in, from 0.
[[nodiscard]] std::vector<std::size_t> blocks_of(const LaterReadings& readings);

/// Sums of whitened squares over these blocks.
[[nodiscard]] std::vector<double> block_sums(const LaterReadings& readings, const Eigen::VectorXd& white);

/// Of paired sums: how often, blocks drawn anew, `worse` is the larger, and the interval of the difference.
/// @param dearer  what `worse` costs beside its sums more than `better`.
struct Resampled {
  double share = 0, lower = 0, upper = 0;
};
[[nodiscard]] Resampled resampled(const std::vector<double>& worse, const std::vector<double>& better,
                                  std::uint64_t seed, double dearer = 0);

}  // namespace softgrip::sysid
