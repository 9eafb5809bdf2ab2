#pragma once
// Compares candidates on held-out blocks, and the chosen one with the others.

#include <cstdint>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// Smallest share of the excess mean square of the model without causes that a further cause must remove. A
/// smaller reduction can result from an inexact form of the first cause. A finger that softens, ages or bends
/// by a law outside the catalogue leaves up to a few percent. Any second block absorbs part of that.
inline constexpr double one_more_share = 0.05;

struct ScoredCandidate {
  Candidate candidate;
  BlockLosses losses;  ///< empty: too far behind for a comparison
};

/// Returns true for a form that can follow any slow signal. It is named only if no physical law explains
/// nearly as much, and it is not an alternative to such a law.
[[nodiscard]] bool is_free_form(const ScoredCandidate& scored);
/// Returns true if the cause has a free form in the model.
[[nodiscard]] bool has_free_form(const model::Model& model, const Cause& cause);

/// Returns true if the other candidate explains the data as well as the best one. Its loss must be smaller in
/// more than 1 of 20 resamples of the held-out blocks.
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
/// @param scored  the candidates that were tested in its place.
[[nodiscard]] ChosenCause weigh(const Cause& cause, const ChosenBetween& between,
                                const std::vector<ScoredCandidate>& scored);

/// Describes the candidates for the report.
[[nodiscard]] std::vector<CandidateScore> describe(const std::vector<ScoredCandidate>& scored,
                                                   const BlockLosses& before, std::uint64_t seed);

}  // namespace softgrip::sysid
