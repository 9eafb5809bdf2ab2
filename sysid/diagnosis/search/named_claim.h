#pragma once
// Tests if a cause that a search has found meets the conditions under which it may be named.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/evidence/veto.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {

/// Function that computes the loss of a structure on each cross-validation unit (divide_by_unit()). For each
/// loss, the structure is fitted to the other units.
using LeftOutLosses = std::function<BlockLosses(const StructureFit&)>;

/// Size of the effect of a block: the distance of one of its parameters from its neutral value. The parameter
/// is the one with the largest distance in standard deviations.
struct BlockSize {
  Interval interval;  ///< 95 % interval of the distance
  double neutral = 0;
  std::string_view unit;
};
/// Returns the size of a block. Returns nullopt if no parameter of the block has a standard deviation and a
/// neutral value.
/// @param position  position of the block in the model.
/// @param space  free parameters of a fit, with the coordinates `z` and the covariance `uncertainty`.
[[nodiscard]] std::optional<BlockSize> size_of(const model::Model& model, std::size_t position,
                                               const FitSpace& space, std::span<const double> z,
                                               const Uncertainty& uncertainty);

/// Returns the first condition (sysid/evidence/veto.h) that a cause does not meet. Returns Veto::none if the
/// cause may be named.
///
/// The size of a cause is the size of its block. The size is not compared with a range if the neutral value
/// has no meaning, for example for a limit. Two conditions are not tested for a free form. A free form cannot
/// predict units to which it was not fitted. It has no single size: if the readings vary at random, each of
/// its parameters is uncertain, although the variation is certain.
/// @param with  fit of the structure with the cause to the records.
/// @param without  fit of the structure without the cause to the records.
/// @param seed  seed of the bootstrap.
[[nodiscard]] Veto veto_of(const std::vector<Record>& records, const Cause& cause, const StructureFit& with,
                           const StructureFit& without, const LeftOutLosses& left_out, std::uint64_t seed);

/// Moves the best candidate that meets all conditions to the front of `scored`. Only the candidate with the
/// lowest loss and candidates that explain the data equally well (ties()) are considered. If a candidate does
/// not meet a condition, this condition is stored as the reason for its rejection. Returns false if no
/// considered candidate meets all conditions.
/// @param scored  candidates, the best first.
/// @param without  structure to which each candidate adds a cause.
/// @param gains  function that returns true if a candidate reduces the error sufficiently. The search ends at
/// the first candidate for which it returns false.
[[nodiscard]] bool put_nameable_first(std::vector<ScoredCandidate>& scored,
                                      const std::vector<Record>& records, const StructureFit& without,
                                      const std::function<bool(const ScoredCandidate&)>& gains,
                                      const LeftOutLosses& left_out, std::uint64_t seed);

}  // namespace softgrip::sysid
