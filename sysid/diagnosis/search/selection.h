#pragma once
// Choosing causes: stepwise, on held-out blocks, with swaps, keeping every rival that explains as much.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/search/confounded.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// How one candidate did, for the report.
struct CandidateScore {
  Cause cause;
  std::string why_not;         ///< it could not be fitted, or why it was not kept
  double rmse_mm = 0;          ///< fitted, all readings
  double heldout_rmse_mm = 0;  ///< NaN where it was too far behind to be refitted
  Spread gain_percent;         ///< held out, over the structure without it
};

/// One cause of the selected set.
struct ChosenCause {
  Cause cause;
  std::vector<Cause> rivals;               ///< each explains as much in its place, or is its twin
  Spread gain_percent;                     ///< held out, of the whole set over the set without it
  std::vector<CandidateScore> candidates;  ///< those tried in its place, best first
  Spread gain_mm2;                         ///< what the held-out mean square falls by with it
  /// How often, over bootstrapped blocks, a structure with the cause loses less than the best without it;
  /// shared with a twin, which would lose the same.
  double inclusion = 0;
};

/// The selected structure.
struct Selection {
  StructureFit base;
  StructureFit extended;  ///< equal to base when nothing was chosen
  std::vector<ChosenCause> chosen;
  std::vector<CandidateScore> last_candidates;  ///< of the search that found nothing more
  BlockLosses base_losses;
  BlockLosses extended_losses;
  Structure base_structure;
  Structure left;                     ///< in the extended structure's residual
  std::vector<Confounded> undecided;  ///< beside the extended structure, and no clear gain over it
};

/// Nothing chosen yet.
[[nodiscard]] Selection selection_from(StructureFit base, BlockLosses losses, double noise_mm);

/// What a cause upon another base must take of the mean square, in squares of the noise: no base has the form
/// of the finger's loop but for a rest, of which one cause or another takes a part in worlds that do not have
/// it.
struct LeastTaken {
  double anyhow;          ///< however it is spread over the blocks
  double in_most_blocks;  ///< where the blocks' losses fall by a tenth and more, most of them
};
/// From the command the rest is the valve's, too: 0.1 to 1.4 of it are taken in vain; what is hidden at twice
/// the noise takes 1.9 to 12 (textbook worlds, and worlds with a lag that differs between filling and
/// venting).
inline constexpr LeastTaken from_the_command{.anyhow = 1.5, .in_most_blocks = 1.5};
/// From the measured pressure 20 textbook worlds without an effect have 0.54 taken in vain, 0.36 in most
/// blocks; a backlash, an asymmetric loop and a loop that depends on the rate, hidden at twice the noise,
/// take 0.2 to 1.5.
inline constexpr LeastTaken from_the_measured_pressure{.anyhow = 1.0, .in_most_blocks = 0.4};

struct SelectionOptions {
  /// Three at once meet almost any curve, named or not: what two leave is said to be unexplained. The
  /// extended model can be diagnosed again.
  std::size_t most_causes = 2;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress;
  /// Told the selection where one cause stands and leaves structure.
  std::function<void(const Selection&)> one_cause_stands;
  /// What another explanation leaves as a mean square: a second cause is followed to the end only where it
  /// comes near. Asked once at most, after one_cause_stands, and not where the looks come as near to the
  /// noise as that. Infinity: there is no other.
  std::function<double()> to_beat_mm2;
  /// The base fitted to other readings of the same records. Empty: it stays as it is but for what it answers
  /// linearly.
  std::function<FitPoint(const std::vector<Record>&)> base_again;
  LeastTaken least_taken = from_the_command;  ///< by each cause upon another base
};

/// @param base  the base structure fitted to data.records.
[[nodiscard]] Selection select_causes(const SearchData& data, StructureFit base, double noise_mm,
                                      const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
