#pragma once
// Selects causes step by step. The selection depends on the losses on held-out blocks, and a later step can
// replace an earlier cause. The result lists all alternatives that explain the data equally well.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// Result for one candidate, as the report shows it.
struct CandidateScore {
  Cause cause;
  std::string why_not;         ///< reason why the candidate was not fitted or was rejected
  double rmse_mm = 0;          ///< RMSE of the fit of the candidate to all readings
  double heldout_rmse_mm = 0;  ///< RMSE on held-out blocks; NaN: not computed, because the candidate was not
                               ///< fitted or enough other candidates have a smaller `rmse_mm`
  Spread gain_percent;         ///< held-out error reduction, compared with the structure without the
                               ///< candidate
};

/// One of the causes that a search has selected.
struct ChosenCause {
  Cause cause;
  /// Held-out error reduction by this cause if all other selected causes are present.
  Spread gain_percent;
  Spread gain_mm2;  ///< reduction of the held-out mean square by this cause
  /// Bootstrap inclusion frequency of this cause. It is the share of the bootstrap samples of blocks in which
  /// the structure with this cause has a lower loss than the best structure without it. Two indistinguishable
  /// causes have equal losses, so each of them gets half of the share.
  double inclusion = 1;
  /// Causes that explain the data as well as this cause, or that no command separates from this cause.
  std::vector<Cause> alternatives;
  /// Candidates that were tested in place of this cause. The best one comes first.
  std::vector<CandidateScore> candidates;
};

/// Returns a cause without alternatives and candidates, with its error reductions on held-out blocks.
/// @param without, with  losses of the structure without and with the cause.
[[nodiscard]] ChosenCause chosen_cause(const Cause& cause, const BlockLosses& without,
                                       const BlockLosses& with, std::uint64_t seed);

/// The selected structure and the evidence for each selected cause.
struct Selection {
  StructureFit base;
  StructureFit extended;  ///< fit of the selected structure; equal to `base` if no cause was selected
  std::vector<ChosenCause> chosen;
  std::vector<CandidateScore> last_candidates;  ///< candidates for a further cause; none of them was accepted
  BlockLosses base_losses;
  BlockLosses extended_losses;
  UnexplainedError base_unexplained;
  UnexplainedError left;  ///< unexplained error of the extended structure
  /// Structures with an additional cause that is confounded with a selected cause. The additional cause does
  /// not reduce the error significantly.
  std::vector<Confounded> undecided;
};

/// Returns a selection without any cause.
[[nodiscard]] Selection selection_from(StructureFit base, BlockLosses losses, double noise_mm,
                                       double step_mm);

/// Smallest reduction of the mean square by a cause that is added to another base structure, as a multiple of
/// the squared noise. The limit is necessary because no base structure matches the hysteresis loop of a
/// finger exactly. A cause that is not present can absorb part of the resulting error.
struct LeastTaken {
  double anyhow;          ///< limit if the reduction comes from a few blocks only
  double in_most_blocks;  ///< limit if the losses of the blocks decrease by more than about 14 % (geometric
                          ///< mean)
};
/// Limits if the input of the model is the command. The remaining error then includes the error of the valve
/// model. In test cases, causes that are not present reduce the mean square by 0.1 to 1.4 times the squared
/// noise. Causes with an effect of twice the noise reduce it by 1.9 to 12 times the squared noise. The test
/// cases are the textbook cases, and cases with different lags for filling and venting.
inline constexpr LeastTaken from_the_command{.anyhow = 1.5, .in_most_blocks = 1.5};
/// Limits if the input of the model is the measured pressure. In 20 textbook test cases, causes that are not
/// present reduce the mean square by at most 0.54 times the squared noise. If the loss decreases in most
/// blocks, this reduction is at most 0.36 times the squared noise. A backlash, an asymmetric loop or a
/// rate-dependent loop with an effect of twice the noise reduces the mean square by 0.2 to 1.5 times the
/// squared noise.
inline constexpr LeastTaken from_the_measured_pressure{.anyhow = 1.0, .in_most_blocks = 0.4};

struct SelectionOptions {
  /// Largest number of causes. Three causes together can fit almost any curve. The error that remains after
  /// two causes is therefore reported as unexplained. The user can diagnose the extended model in a second
  /// run.
  std::size_t most_causes = 2;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress;
  /// Function that is called after the first cause was accepted, if an unexplained error remains. It receives
  /// the selection.
  std::function<void(const Selection&)> one_cause_stands;
  /// Function that returns the mean square of another explanation of the data, or infinity if there is no
  /// other explanation. A second cause gets a full fit only if its mean square is not much larger. The
  /// function is called at most once, and only after one_cause_stands. It is not called if a second cause
  /// reduces the error nearly to the noise.
  std::function<double()> to_beat_mm2;
  /// Function that fits the base structure to modified readings of the same records. Empty: the base
  /// structure is not refitted and only responds linearly.
  std::function<FitPoint(const std::vector<Record>&)> base_again;
  /// Smallest error reduction by a cause that is accepted on another base structure.
  LeastTaken least_taken = from_the_command;
};

/// Selects causes that are added to a base structure.
/// @param base  base structure, fitted to data.records.
[[nodiscard]] Selection select_causes(const SearchData& data, StructureFit base, double noise_mm,
                                      const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
