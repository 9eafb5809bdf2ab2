#pragma once
// Finds the effects in one reading, one after the other. Each is compared with the results of the same search
// in healthy readings.

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
  double gain = 0;       ///< improvement of the whitened squares per row minus the penalty
  double usual = 0;      ///< mean improvement by the cause in healthy units that are left out
  double tolerance = 0;  ///< smallest improvement of a change
};

/// Penalty for the parameters of an effect, in whitened squares.
[[nodiscard]] double price_of(const Effect& effect);

/// Penalty for the parameters of an effect, divided by the number of rows.
[[nodiscard]] double price_per_row(const LaterReadings& readings, const Effect& effect);

/// Returns true if the data cannot separate two effects: the best one improves the readings more than the
/// other one by no more than its tolerance. Causes that are declared indistinguishable always tie.
using Ties = std::function<bool(const ScoredEffect& best, const ScoredEffect& other)>;
[[nodiscard]] Ties ties_in(const LaterReadings& readings, std::uint64_t seed);

/// Returns the effects, the one with the largest improvement beyond the usual first. Each cause has one form:
/// of several forms that tie, the one with the fewest parameters.
[[nodiscard]] std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings,
                                                       const std::vector<Effect>& effects,
                                                       const std::vector<FittedEffect>& others,
                                                       const Tolerance& tolerance, unsigned threads);

/// Moves the effect with the fewest parameters to the front, of the first one and those that tie with it.
/// Parameters of the shape count before those of its reference. With equal numbers, an effect that is not
/// ideal is preferred.
void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked, const Ties& ties);

/// Returns for every row of the readings the index of its block of some seconds.
[[nodiscard]] std::vector<std::size_t> blocks_of(const LaterReadings& readings);

/// Returns the whitened squares of two residuals by block.
/// @param rows  one flag for each row: true if it counts; nullptr: all count.
[[nodiscard]] PairedLosses paired_losses(const LaterReadings& readings, const Eigen::VectorXd& worse,
                                         const Eigen::VectorXd& better,
                                         const std::vector<bool>* rows = nullptr);

}  // namespace softgrip::sysid
