#pragma once
// Selects causes stepwise by their losses on held-out blocks, and replaces earlier causes if others are
// better. Every alternative that explains the data equally well is listed.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/search/confounded.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// Result of one candidate, for the report.
struct CandidateScore {
  Cause cause;
  std::string why_not;         ///< reason why the candidate has no fit or was rejected
  double rmse_mm = 0;          ///< RMSE of the fit on all readings
  double heldout_rmse_mm = 0;  ///< NaN if the fit was too much worse than the best one for refits
  Spread gain_percent;         ///< held-out error reduction relative to the structure without the candidate
};

/// One cause of the selected set.
struct ChosenCause {
  Cause cause;
  std::vector<Cause>
      alternatives;     ///< causes that explain the data equally well or are indistinguishable from this one
  Spread gain_percent;  ///< held-out error reduction of all selected causes relative to the others without
                        ///< this one
  std::vector<CandidateScore> candidates;  ///< candidates for the place of this cause, the best first
  Spread gain_mm2;                         ///< decrease of the held-out mean square by this cause
  /// Bootstrap inclusion frequency: share of the bootstrap samples of blocks in which a structure with the
  /// cause has a lower loss than the best structure without it. The share is divided equally between
  /// indistinguishable causes, because their losses are equal.
  double inclusion = 0;
};

/// The selected structure.
struct Selection {
  StructureFit base;
  StructureFit extended;  ///< equal to `base` if no cause was selected
  std::vector<ChosenCause> chosen;
  std::vector<CandidateScore> last_candidates;  ///< candidates for a further cause, of which none was
                                                ///< selected
  BlockLosses base_losses;
  BlockLosses extended_losses;
  UnexplainedError base_unexplained;
  UnexplainedError left;  ///< unexplained error of the extended structure
  /// confounded causes that were fitted in addition to the extended structure without a significant error
  /// reduction
  std::vector<Confounded> undecided;
};

/// Returns a selection without causes.
[[nodiscard]] Selection selection_from(StructureFit base, BlockLosses losses, double noise_mm);

/// Smallest reduction of the mean square by a cause on another base structure, as a multiple of the squared
/// noise. No base structure matches the hysteresis loop of a finger exactly. A cause that is absent can
/// absorb part of the error that this leaves.
struct LeastTaken {
  double anyhow;          ///< limit if the reduction may be concentrated in a few blocks
  double in_most_blocks;  ///< limit if the losses of most blocks fall by at least about 10 %
};
/// Limits for a model with the command as input, whose remaining error includes that of the valve. Absent
/// causes absorb 0.1 to 1.4 squares of the noise. Causes hidden at twice the noise absorb 1.9 to 12. The
/// values come from textbook test cases and from test cases with a different lag for filling and venting.
inline constexpr LeastTaken from_the_command{.anyhow = 1.5, .in_most_blocks = 1.5};
/// Limits for a model with the measured pressure as input. In 20 textbook test cases without an effect,
/// absent causes absorb up to 0.54 squares of the noise, and up to 0.36 if most blocks improve. A backlash,
/// an asymmetric loop or a rate-dependent loop hidden at twice the noise absorbs 0.2 to 1.5.
inline constexpr LeastTaken from_the_measured_pressure{.anyhow = 1.0, .in_most_blocks = 0.4};

struct SelectionOptions {
  /// Maximum number of causes. Three causes together can fit almost any curve, so the error that two causes
  /// leave is reported as unexplained. The extended model can be diagnosed again.
  std::size_t most_causes = 2;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress;
  /// Called with the selection when its first cause has been accepted and unexplained error remains.
  std::function<void(const Selection&)> one_cause_stands;
  /// Returns the mean square that another explanation leaves. A second cause is fitted completely only if its
  /// mean square is not much larger. Called at most once, after one_cause_stands, and only if no second cause
  /// reduces the error nearly to the noise. Infinity: there is no other explanation.
  std::function<double()> to_beat_mm2;
  /// Fits the base structure to other readings of the same records. Empty: the base structure is not refitted
  /// and only responds linearly.
  std::function<FitPoint(const std::vector<Record>&)> base_again;
  LeastTaken least_taken = from_the_command;  ///< smallest reduction by each cause on another base structure
};

/// Selects causes on the base structure.
/// @param base  base structure fitted to data.records.
[[nodiscard]] Selection select_causes(const SearchData& data, StructureFit base, double noise_mm,
                                      const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
