#pragma once
// Computes one result for a grip of several fingers.

#include <cstdint>
#include <span>

#include "control/elements/grip_result.h"

namespace softgrip::daemon {

/// Returns the result for the fingers in `members` (bit i: results[i]). If any finger has error, part_lost or
/// no_part, the result is the first of these three that occurs. Otherwise it is the result that all fingers
/// share. It is `none` if they share no result, or if `members` is 0.
[[nodiscard]] control::GripResult overall_result(std::span<const control::GripResult> results,
                                                 std::uint32_t members) noexcept;

}  // namespace softgrip::daemon
