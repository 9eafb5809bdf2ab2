#pragma once
// Combines the results of several fingers into one overall result of the grip.

#include <cstdint>
#include <span>

#include "control/elements/grip_result.h"

namespace softgrip::daemon {

/// Returns the overall result of the fingers in `members` (bit i: results[i]). The results error, part_lost
/// and no_part have priority, in this order: the first of them that any finger has is the overall result. If
/// no finger has any of these three and all fingers have the same result, this result is the overall result.
/// In all other cases, and if `members` is 0, the overall result is `none`.
[[nodiscard]] control::GripResult overall_result(std::span<const control::GripResult> results,
                                                 std::uint32_t members) noexcept;

}  // namespace softgrip::daemon
