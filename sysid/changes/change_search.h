#pragma once
// Finds the effects in one quantity, one after the other. The error reduction by each effect is compared with
// the error reduction that the same search finds in readings of the healthy finger.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sysid/changes/effect_fit.h"
#include "sysid/evidence/comparison.h"

namespace softgrip::sysid {

struct ScoredEffect {
  EffectFit fit;
  /// Reduction of the whitened sum of squares by the effect, minus the penalty for its parameters, divided by
  /// the number of rows.
  double gain = 0;
  double usual = 0;      ///< mean of `gain` for this cause in healthy runs, each of which was left out of the
                         ///< fit
  double tolerance = 0;  ///< limit of `gain` above which the cause counts as a change
};

/// Returns price_of() divided by the number of rows of the readings.
[[nodiscard]] double price_per_row(const LaterReadings& readings, const Effect& effect);

/// Returns true if the data cannot separate two effects. The data separate them if `best` has a significantly
/// smaller sum of squares, and the difference exceeds the tolerance of `best`. The result is always true for
/// causes that are declared indistinguishable.
using Ties = std::function<bool(const ScoredEffect& best, const ScoredEffect& other)>;
[[nodiscard]] Ties ties_in(const LaterReadings& readings, std::uint64_t seed);

/// Returns the effects sorted by `gain` minus `usual`, the largest value first. The list contains one effect
/// per cause, and no cause of `others`, the effects that were found before. If the data cannot separate
/// several forms of a cause, the list contains the form with the fewest parameters.
[[nodiscard]] std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings,
                                                       std::vector<Effect> effects,
                                                       const std::vector<FittedEffect>& others,
                                                       const Tolerance& tolerance, unsigned threads);

/// Moves one effect to the front of the list. It is the effect with the fewest parameters among the first
/// effect and the effects that the data cannot separate from it. The function first compares the number of
/// parameters that determine the shape, and then the number of all parameters. If both numbers are equal, it
/// prefers an effect that is not a mathematical idealisation (Effect::is_ideal).
void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked, const Ties& ties);

/// Returns one index per row of the readings: the block that contains the row. A block lasts some seconds.
[[nodiscard]] std::vector<std::size_t> blocks_of(const LaterReadings& readings);

/// Returns the sums of the squares of two whitened residuals in each block.
/// @param rows  one element per row; rows with the value false are ignored; nullptr: all rows are used.
[[nodiscard]] PairedLosses paired_losses(const LaterReadings& readings, const Eigen::VectorXd& worse,
                                         const Eigen::VectorXd& better,
                                         const std::vector<bool>* rows = nullptr);

}  // namespace softgrip::sysid
