#pragma once
// Tests whether a cause that a search has found meets the conditions for being named.

#include <cstdint>
#include <functional>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/evidence/veto.h"

namespace softgrip::sysid {

/// Computes the losses of a structure in units (divide_by_unit()) to which its parameters were not fitted.
using LeftOutLosses = std::function<BlockLosses(const StructureFit&)>;

/// Returns the first condition (sysid/evidence/veto.h) that a cause does not meet, or Veto::none if the cause
/// may be named.
///
/// The size of a cause is the parameter with the largest distance from its neutral value, in standard
/// deviations. A cause without a neutral value, for example a limit, has no size limit. A free form cannot
/// predict units to which it was not fitted, so its predictions are not tested.
/// @param with  fit of the structure with the cause to the records.
/// @param without  fit of the structure without the cause to the records.
/// @param seed  seed of the bootstrap.
[[nodiscard]] Veto veto_of(const std::vector<Record>& records, const Cause& cause, const StructureFit& with,
                           const StructureFit& without, const LeftOutLosses& left_out, std::uint64_t seed);

/// Moves the best candidate that meets all conditions to the front. Only the candidate with the lowest loss
/// and candidates that explain the data equally well (ties()) are considered. Each candidate that does not
/// meet a condition receives the reason. Returns false if none of them meets all conditions.
/// @param scored  candidates, the best first. @param without  the structure that each candidate extends.
/// @param gains  returns true if the error reduction of a candidate is sufficient. The search ends at the
/// first candidate whose reduction is not.
[[nodiscard]] bool put_nameable_first(std::vector<ScoredCandidate>& scored,
                                      const std::vector<Record>& records, const StructureFit& without,
                                      const std::function<bool(const ScoredCandidate&)>& gains,
                                      const LeftOutLosses& left_out, std::uint64_t seed);

}  // namespace softgrip::sysid
