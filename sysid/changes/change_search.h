#pragma once
// Which effects one reading shows, one after the other, each against what the same search finds in healthy
// ones.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sysid/changes/effect_fit.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/tolerance.h"

namespace softgrip::sysid {

struct ScoredEffect {
  EffectFit fit;
  double gain = 0;       ///< whitened squares per row that it takes, less what its numbers cost
  double usual = 0;      ///< what its cause improves in healthy units that are left out, on average
  double tolerance = 0;  ///< what it must improve to be a change
};

/// Penalty for the parameters of an effect, in whitened squares.
[[nodiscard]] double price_of(const Effect& effect);

/// Penalty for the parameters of an effect, divided by the number of rows.
[[nodiscard]] double price_per_row(const LaterReadings& readings, const Effect& effect);

/// Returns true if the data cannot separate two effects: the best one improves the readings more than the
/// other one by no more than its tolerance. Causes that are declared indistinguishable always tie.
using Ties = std::function<bool(const ScoredEffect& best, const ScoredEffect& other)>;
[[nodiscard]] Ties ties_in(const LaterReadings& readings, std::uint64_t seed);

/// The effect that improves most beyond the usual first; of every cause one form, among forms that tie the
/// one with the fewest numbers.
[[nodiscard]] std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings,
                                                       const std::vector<Effect>& effects,
                                                       const std::vector<FittedEffect>& others,
                                                       const Tolerance& tolerance, unsigned threads);

/// Puts the effect with the fewest numbers first, among the first and those that tie with it. Numbers that
/// shape it are counted before those that only say where it is counted from. Of as many numbers, one that is
/// no ideal is preferred.
void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked, const Ties& ties);

/// Of every row of the readings, which block of some seconds it is in, from 0.
[[nodiscard]] std::vector<std::size_t> blocks_of(const LaterReadings& readings);

/// Whitened squares of two residuals over these blocks.
/// @param rows  of the readings that count, one flag each; nullptr: all.
[[nodiscard]] PairedLosses paired_losses(const LaterReadings& readings, const Eigen::VectorXd& worse,
                                         const Eigen::VectorXd& better,
                                         const std::vector<bool>* rows = nullptr);

}  // namespace softgrip::sysid
