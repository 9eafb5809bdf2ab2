#pragma once
// Computes one result for a grip of several fingers.

#include <cstdint>
#include <span>

#include "control/elements/grip_result.h"

namespace softgrip::daemon {

/// Returns the result for the fingers in `members` (bit i: results[i]). It is the worst one of error,
/// part_lost and no_part if any finger has it; otherwise the result that all fingers share; otherwise none.
/// The result is also `none` without members.
[[nodiscard]] control::GripResult overall_result(std::span<const control::GripResult> results,
                                                 std::uint32_t members) noexcept;

}  // namespace softgrip::daemon
