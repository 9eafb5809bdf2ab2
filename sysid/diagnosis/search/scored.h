#pragma once
// Compares candidates on held-out blocks, and the chosen candidate with the others.

#include <cstdint>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// Smallest share of the excess mean square of the model without causes that a further cause must remove. A
/// smaller reduction can result from an inexact form of the first cause: if a finger softens, ages or bends
/// by a law that is not in the catalogue, the first cause leaves up to a few percent, and any second block
/// absorbs part of this remainder.
inline constexpr double one_more_share = 0.05;

struct ScoredCandidate {
  Candidate candidate;
  BlockLosses losses;  ///< held-out losses; empty: the fit is too much worse than the best one for a
                       ///< comparison
};

/// Returns true if the candidate was fitted in a form that can follow any slow signal. Such a form is named
/// only if no physical law explains nearly as much, and it is never an alternative to such a law.
[[nodiscard]] bool is_free_form(const ScoredCandidate& scored);
/// Returns true if the cause has a free form in the model.
[[nodiscard]] bool has_free_form(const model::Model& model, const Cause& cause);

/// Returns true if the other candidate explains the data as well as the best one: its loss is smaller in more
/// than 5 % of the bootstrap samples of the held-out blocks.
[[nodiscard]] bool ties(const ScoredCandidate& best, const ScoredCandidate& other, std::uint64_t seed);

/// The structures with and without a chosen cause.
struct ChosenBetween {
  const StructureFit& with;
  const BlockLosses& with_losses;
  const BlockLosses& without_losses;
  double noise_mm;
  std::uint64_t seed;
};

/// Computes error reductions, inclusion frequency and alternatives of a cause.
/// @param scored  the candidates that were tested in the place of the cause.
[[nodiscard]] ChosenCause weigh(const Cause& cause, const ChosenBetween& between,
                                const std::vector<ScoredCandidate>& scored);

/// Describes the candidates for the report.
[[nodiscard]] std::vector<CandidateScore> describe(const std::vector<ScoredCandidate>& scored,
                                                   const BlockLosses& before, std::uint64_t seed);

}  // namespace softgrip::sysid
