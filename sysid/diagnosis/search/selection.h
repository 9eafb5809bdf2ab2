#pragma once
// Selects causes step by step according to their losses on held-out blocks, and replaces an earlier cause if
// another cause is better. The result lists every alternative that explains the data equally well.

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
  double heldout_rmse_mm = 0;  ///< RMSE on held-out blocks; NaN if the fit was much worse than the best fit
  Spread gain_percent;         ///< held-out error reduction relative to the structure without the candidate
};

/// One of the causes that a search has selected.
struct ChosenCause {
  Cause cause;
  /// Causes that explain the data equally well, or that no command separates from this cause.
  std::vector<Cause> alternatives;
  /// held-out error reduction by this cause in a structure with all other selected causes
  Spread gain_percent;
  /// Candidates that were tested as a replacement of this cause; the best one comes first.
  std::vector<CandidateScore> candidates;
  Spread gain_mm2;  ///< reduction of the held-out mean square by this cause
  /// Bootstrap inclusion frequency. This is the share of the bootstrap samples of blocks in which a structure
  /// with this cause has a lower loss than the best structure without it. Indistinguishable causes have equal
  /// losses, so the share is divided equally between them.
  double inclusion = 0;
};

/// The selected structure and the evidence for it.
struct Selection {
  StructureFit base;
  StructureFit extended;  ///< fit of the selected structure; equal to `base` if no cause was selected
  std::vector<ChosenCause> chosen;
  std::vector<CandidateScore> last_candidates;  ///< candidates for a further cause that were rejected
  BlockLosses base_losses;
  BlockLosses extended_losses;
  UnexplainedError base_unexplained;
  UnexplainedError left;  ///< unexplained error of the extended structure
  /// Structures with one additional cause that is confounded with a selected cause and does not reduce the
  /// error significantly.
  std::vector<Confounded> undecided;
};

/// Returns a selection that contains no causes.
[[nodiscard]] Selection selection_from(StructureFit base, BlockLosses losses, double noise_mm);

/// Smallest reduction of the mean square by a cause that is added to another base structure, as a multiple of
/// the squared noise. No base structure matches the hysteresis loop of a finger exactly. A cause whose effect
/// is not in the data can absorb part of the resulting error.
struct LeastTaken {
  double anyhow;          ///< limit for a reduction that may be restricted to a few blocks
  double in_most_blocks;  ///< limit for a reduction by at least about 10 % in most blocks
};
/// Limits for a model whose input is the command. The remaining error then includes the error of the valve
/// model. Causes without an effect in the data reduce the mean square by 0.1 to 1.4 times the squared noise.
/// Causes with an effect of twice the noise reduce it by 1.9 to 12 times the squared noise. The values come
/// from textbook test cases and from test cases whose lag differs between filling and venting.
inline constexpr LeastTaken from_the_command{.anyhow = 1.5, .in_most_blocks = 1.5};
/// Limits for a model whose input is the measured pressure. In 20 textbook test cases without an effect,
/// causes reduce the mean square by up to 0.54 times the squared noise, and by up to 0.36 times if most
/// blocks improve. A backlash, an asymmetric loop or a rate-dependent loop with an effect of twice the noise
/// reduces it by 0.2 to 1.5 times the squared noise.
inline constexpr LeastTaken from_the_measured_pressure{.anyhow = 1.0, .in_most_blocks = 0.4};

struct SelectionOptions {
  /// Maximum number of causes. Three causes together can fit almost any curve, so the error that two causes
  /// leave is reported as unexplained. The user can diagnose the extended model in a second run.
  std::size_t most_causes = 2;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress;
  /// Called with the selection after its first cause was accepted, if an unexplained error remains.
  std::function<void(const Selection&)> one_cause_stands;
  /// Returns the mean square that another explanation of the data leaves. Returns infinity if there is no
  /// other explanation. A second cause is fitted completely only if it leaves at most a slightly larger mean
  /// square. The function is called at most once, after one_cause_stands. It is not called if a second cause
  /// reduces the error nearly to the noise.
  std::function<double()> to_beat_mm2;
  /// Fits the base structure to modified readings of the same records. If the function is empty, the base
  /// structure is not refitted and only responds linearly.
  std::function<FitPoint(const std::vector<Record>&)> base_again;
  /// Smallest error reduction by a cause that is added to another base structure.
  LeastTaken least_taken = from_the_command;
};

/// Selects causes in addition to a base structure.
/// @param base  base structure that was fitted to data.records.
[[nodiscard]] Selection select_causes(const SearchData& data, StructureFit base, double noise_mm,
                                      const Division& division, const SelectionOptions& options);

}  // namespace softgrip::sysid
