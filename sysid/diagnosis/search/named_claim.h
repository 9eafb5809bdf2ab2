#pragma once
// Tests the conditions under which a cause that a search has found may be named.

#include <cstdint>
#include <functional>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/evidence/veto.h"

namespace softgrip::sysid {

/// Computes the losses of a structure in units to which its parameters were not fitted, by divide_by_unit().
using LeftOutLosses = std::function<BlockLosses(const StructureFit&)>;

/// Returns the first condition (sysid/evidence/veto.h) that a cause does not meet; Veto::none: it may be
/// named.
///
/// The size of a cause is the parameter that is farthest from its neutral value, in standard deviations. A
/// cause without such a parameter, for example a limit, has no size limit. A free form makes no prediction
/// for units to which it was not fitted, so that condition is not tested.
/// @param with, without  fitted to the records, with the cause and without it. @param seed  of the bootstrap.
[[nodiscard]] Veto veto_of(const std::vector<Record>& records, const Cause& cause, const StructureFit& with,
                           const StructureFit& without, const LeftOutLosses& left_out, std::uint64_t seed);

/// Moves the first candidate that meets all conditions to the front: the one with the largest error
/// reduction, or one that ties with it. A candidate that does not meet a condition receives the reason.
/// Returns false if no candidate meets all.
/// @param scored  best first. @param without  the structure that each candidate extends.
/// @param gains   returns true if a candidate has a sufficient error reduction; candidates after the first
/// without one are ignored.
[[nodiscard]] bool put_nameable_first(std::vector<ScoredCandidate>& scored,
                                      const std::vector<Record>& records, const StructureFit& without,
                                      const std::function<bool(const ScoredCandidate&)>& gains,
                                      const LeftOutLosses& left_out, std::uint64_t seed);

}  // namespace softgrip::sysid
