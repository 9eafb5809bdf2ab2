#pragma once
// Finds the effects in one quantity, one after the other. The error reduction by each effect is compared with
// the reduction that an equal search finds in readings of the healthy finger.

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
  /// Reduction of the whitened sum of squares minus the penalty for parameters, per row.
  double gain = 0;
  double usual = 0;      ///< mean of `gain` for this cause in healthy units that were left out of the fit
  double tolerance = 0;  ///< smallest value of `gain` that counts as a change
};

/// Returns the penalty for the parameters of an effect, in whitened squares.
[[nodiscard]] double price_of(const Effect& effect);

/// Returns price_of() divided by the number of rows.
[[nodiscard]] double price_per_row(const LaterReadings& readings, const Effect& effect);

/// Returns true if the data cannot separate two effects. This is the case if the sum of squares with `best`
/// is smaller than that with the other effect by at most the tolerance of `best`. It is always the case for
/// causes that are declared indistinguishable.
using Ties = std::function<bool(const ScoredEffect& best, const ScoredEffect& other)>;
[[nodiscard]] Ties ties_in(const LaterReadings& readings, std::uint64_t seed);

/// Returns the effects sorted by `gain` minus `usual`, the largest value first. Each cause has one element.
/// If several of its forms tie, this is the form with the fewest parameters.
[[nodiscard]] std::vector<ScoredEffect> ranked_effects(const LaterReadings& readings,
                                                       const std::vector<Effect>& effects,
                                                       const std::vector<FittedEffect>& others,
                                                       const Tolerance& tolerance, unsigned threads);

/// Selects the effect with the fewest parameters among the first effect and the effects that tie with it, and
/// moves it to the front. The number of parameters that determine the shape is compared first, and then the
/// number of all parameters. If both numbers are equal, an effect that is not ideal is preferred.
void put_fewest_numbers_first(std::vector<ScoredEffect>& ranked, const Ties& ties);

/// Returns, for every row of the readings, the index of its block. A block contains some seconds.
[[nodiscard]] std::vector<std::size_t> blocks_of(const LaterReadings& readings);

/// Returns the sums of whitened squares of two residuals in each block.
/// @param rows  one element per row; a row whose element is false is not used; nullptr: all rows are used.
[[nodiscard]] PairedLosses paired_losses(const LaterReadings& readings, const Eigen::VectorXd& worse,
                                         const Eigen::VectorXd& better,
                                         const std::vector<bool>* rows = nullptr);

}  // namespace softgrip::sysid
