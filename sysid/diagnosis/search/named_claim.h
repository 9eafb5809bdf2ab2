#pragma once
// The conditions of every name for one cause that a search has found.

#include <cstdint>
#include <functional>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/evidence/veto.h"

namespace softgrip::sysid {

/// Losses of a structure in the units that its numbers were not fitted to, by divide_by_unit().
using LeftOutLosses = std::function<BlockLosses(const StructureFit&)>;

/// The first condition (sysid/evidence/veto.h) that a cause fails; Veto::none: it may be named.
///
/// Its size is the number that is farthest, in standard deviations, from where the cause does nothing. A
/// cause without such a number, as a limit, has an effect of any size. A free form says nothing of units that
/// it was not fitted to: there it is not judged.
/// @param with, without  fitted to the records, with the cause and without. @param seed  of the draws.
[[nodiscard]] Veto veto_of(const std::vector<Record>& records, const Cause& cause, const StructureFit& with,
                           const StructureFit& without, const LeftOutLosses& left_out, std::uint64_t seed);

/// Puts a candidate first that meets all conditions of a name: the one that gains most, or one that ties with
/// it. A candidate that fails a condition gets the reason. Returns false if there is none.
/// @param scored  best first. @param without  the structure that each candidate extends.
/// @param gains   whether a candidate is worth a name; none behind the first that is not.
[[nodiscard]] bool put_nameable_first(std::vector<ScoredCandidate>& scored,
                                      const std::vector<Record>& records, const StructureFit& without,
                                      const std::function<bool(const ScoredCandidate&)>& gains,
                                      const LeftOutLosses& left_out, std::uint64_t seed);

}  // namespace softgrip::sysid
