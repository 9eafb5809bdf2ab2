#pragma once
// Tests whether a cause that a search has found fulfils the conditions for being named.

#include <cstdint>
#include <functional>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/evidence/veto.h"

namespace softgrip::sysid {

/// Computes the losses of a structure in units (divide_by_unit()) to which its parameters were not fitted.
using LeftOutLosses = std::function<BlockLosses(const StructureFit&)>;

/// Returns the first condition (sysid/evidence/veto.h) that a cause does not fulfil. Returns Veto::none if
/// the cause may be named.
///
/// The size of a cause is the value of one of its parameters: the parameter that differs most from its
/// neutral value, in standard deviations. The size is not tested if this neutral value has no meaning, for
/// example for a limit. The predictions of a free form are not tested, because a free form cannot predict
/// units to which it was not fitted.
/// @param with  fit of the structure with the cause to the records.
/// @param without  fit of the structure without the cause to the records.
/// @param seed  seed of the bootstrap.
[[nodiscard]] Veto veto_of(const std::vector<Record>& records, const Cause& cause, const StructureFit& with,
                           const StructureFit& without, const LeftOutLosses& left_out, std::uint64_t seed);

/// Moves the best candidate that fulfils all conditions to the front of `scored`. Only candidates with the
/// lowest loss, or with an equally good explanation of the data (ties()), are considered. A candidate that
/// does not fulfil a condition receives this condition as the reason for its rejection. Returns false if no
/// considered candidate fulfils all conditions.
/// @param scored  candidates, the best first. @param without  the structure that each candidate extends.
/// @param gains  returns true if a candidate reduces the error sufficiently. The search ends at the first
/// candidate for which `gains` returns false.
[[nodiscard]] bool put_nameable_first(std::vector<ScoredCandidate>& scored,
                                      const std::vector<Record>& records, const StructureFit& without,
                                      const std::function<bool(const ScoredCandidate&)>& gains,
                                      const LeftOutLosses& left_out, std::uint64_t seed);

}  // namespace softgrip::sysid
