#pragma once
// Defines the grip result: HOLDING, NO PART, PART LOST, RELEASED or ERROR.
// Combines the results of several fingers into one overall result of the grip.

#include <cstdint>
#include <span>
#include <string_view>

namespace softgrip::control {

/// The grip result of one channel. The result remains until a reset (`acknowledge`) or the next start of a
/// sequence.
enum class GripResult : std::uint8_t {
  none,       ///< there has been no grip since the last start or reset
  holding,    ///< HOLDING: an object was detected and verified
  no_part,    ///< NO PART: the verification found no evidence of an object
  part_lost,  ///< PART LOST: an object was held before, but is not held any more
  released,   ///< RELEASED: a release step or a vent has released the object
  error,      ///< ERROR: because of a failed step, a fault, a stop or an aborted start, there is no reliable
              ///< result
};
/// Returns the name that the user sees: "HOLDING", "NO PART", "PART LOST", "RELEASED" or "ERROR". Returns "-"
/// for none.
[[nodiscard]] std::string_view title_of(GripResult result) noexcept;
/// Returns the name of a grip result in files and in messages for programs: "holding", "no_part", ...
[[nodiscard]] std::string_view name_of(GripResult result) noexcept;

/// The evidence on which the verification of a grip is based.
enum class GripEvidence : std::uint8_t {
  none,
  displacement,  ///< the finger moved less than its free-motion model
  pressure,      ///< weaker evidence: only the pressure, because no displacement is available
};
/// Returns the name of the evidence: "none", "displacement" or "pressure (weaker)".
[[nodiscard]] std::string_view name_of(GripEvidence evidence) noexcept;

/// Returns the overall result of the fingers in `members` (bit i: results[i]). The results error, part_lost
/// and no_part have priority, in this order: the first of them that any finger has is the overall result. If
/// no finger has any of these three and all fingers have the same result, this result is the overall result.
/// In all other cases, and if `members` is 0, the overall result is `none`.
[[nodiscard]] GripResult overall_result(std::span<const GripResult> results, std::uint32_t members) noexcept;

}  // namespace softgrip::control
