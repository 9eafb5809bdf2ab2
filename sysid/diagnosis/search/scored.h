#pragma once
// Compares candidates for a cause on held-out blocks, and compares the chosen candidate with all other
// candidates.

#include <cstdint>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

struct ScoredCandidate {
  Candidate candidate;
  BlockLosses losses;  ///< losses on held-out blocks; empty: the fit was much worse than the best fit
};

/// Returns true if the candidate was fitted in a form that can follow any slow signal. A form of this type is
/// named only if no physical law explains nearly as much. It is never an alternative to a physical law.
[[nodiscard]] bool is_free_form(const ScoredCandidate& scored);
/// Returns true if the block of the cause in the model has a free form.
[[nodiscard]] bool has_free_form(const model::Model& model, const Cause& cause);

/// Returns true if `other` explains the data as well as the best candidate: `other` has the smaller loss in
/// more than 5 % of the bootstrap samples of the held-out blocks.
[[nodiscard]] bool ties(const ScoredCandidate& best, const ScoredCandidate& other, std::uint64_t seed);

/// The fits and losses of a structure with and without a chosen cause.
struct ChosenBetween {
  const StructureFit& with;
  const BlockLosses& with_losses;
  const BlockLosses& without_losses;
  double noise_mm;
  std::uint64_t seed;
};

/// Computes the error reductions, the inclusion frequency and the alternatives of a cause.
/// @param scored  candidates that were tested as a replacement of the cause.
[[nodiscard]] ChosenCause weigh(const Cause& cause, const ChosenBetween& between,
                                const std::vector<ScoredCandidate>& scored);

/// Returns a description of each candidate for the report.
[[nodiscard]] std::vector<CandidateScore> describe(const std::vector<ScoredCandidate>& scored,
                                                   const BlockLosses& before, std::uint64_t seed);

}  // namespace softgrip::sysid
