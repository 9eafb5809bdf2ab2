#pragma once
// Compares candidates for a cause on held-out blocks, and finds the candidates that explain the data as well
// as the chosen one.

#include <cstdint>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

struct ScoredCandidate {
  Candidate candidate;
  BlockLosses losses;  ///< losses on held-out blocks; empty: not computed, because enough other candidates
                       ///< have a smaller fitted error
};

/// Returns true if the candidate was fitted in a free form, which can follow any slow signal. A free form is
/// named only if no physical law explains nearly as much. It is never listed as an alternative to a physical
/// law.
[[nodiscard]] bool is_free_form(const ScoredCandidate& scored);
/// Returns true if the block in the model that belongs to this cause has a free form.
[[nodiscard]] bool has_free_form(const model::Model& model, const Cause& cause);

/// Returns true if `other` explains the data as well as `best`. This is the case if `other` has the smaller
/// loss in more than 5 % of the bootstrap samples of the held-out blocks.
[[nodiscard]] bool ties(const ScoredCandidate& best, const ScoredCandidate& other, std::uint64_t seed);

/// A structure with a chosen cause, the losses of this structure, and the losses of the structure without the
/// cause.
struct ChosenBetween {
  const StructureFit& with;
  const BlockLosses& with_losses;
  const BlockLosses& without_losses;
  double noise_mm;
  std::uint64_t seed;
};

/// Computes the error reductions, the inclusion frequency and the alternatives of a cause.
/// @param scored  candidates that were tested in place of the cause.
[[nodiscard]] ChosenCause weigh(const Cause& cause, const ChosenBetween& between,
                                const std::vector<ScoredCandidate>& scored);

/// Returns the result for each candidate as the report shows it.
[[nodiscard]] std::vector<CandidateScore> describe(const std::vector<ScoredCandidate>& scored,
                                                   const BlockLosses& before, std::uint64_t seed);

}  // namespace softgrip::sysid
