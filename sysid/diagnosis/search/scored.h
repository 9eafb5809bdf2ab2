#pragma once
// Candidates judged on held-out blocks, and what the others say of the one that was chosen.

#include <cstdint>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

/// What one more cause must take of the excess of what stands without any, as a mean square. Less makes up
/// for the form of an equation that the first cause does not quite have: a finger that softens, ages or bends
/// by another law than the catalogue's leaves up to some percent, and any second block takes part of that.
inline constexpr double one_more_share = 0.05;

struct ScoredCandidate {
  Candidate candidate;
  BlockLosses losses;  ///< empty: too far behind to be judged
};

/// A form that can follow anything slow is named only where no law explains nearly as much, and is no rival
/// of one that does.
[[nodiscard]] bool is_free_form(const ScoredCandidate& scored);
/// The same of a cause that the model has.
[[nodiscard]] bool has_free_form(const model::Model& model, const Cause& cause);

/// Whether another candidate explains as much as the best one: it loses less in more than 1 of 20 draws of
/// the held-out blocks.
[[nodiscard]] bool ties(const ScoredCandidate& best, const ScoredCandidate& other, std::uint64_t seed);

/// The structures with and without a chosen cause.
struct ChosenBetween {
  const StructureFit& with;
  const BlockLosses& with_losses;
  const BlockLosses& without_losses;
  double noise_mm;
  std::uint64_t seed;
};

/// Gains, inclusion and rivals of a cause.
/// @param scored  what was tried in its place.
[[nodiscard]] ChosenCause weigh(const Cause& cause, const ChosenBetween& between,
                                const std::vector<ScoredCandidate>& scored);

/// For the report.
[[nodiscard]] std::vector<CandidateScore> describe(const std::vector<ScoredCandidate>& scored,
                                                   const BlockLosses& before, std::uint64_t seed);

}  // namespace softgrip::sysid
