#pragma once
// One answer for a grip of several fingers.

#include <cstdint>
#include <span>

#include "control/elements/grip_result.h"

namespace softgrip::daemon {

/// Of the fingers of `members` (bit i: results[i]): what is worst of any (error, part_lost, no_part), or else
/// what is true of all; none otherwise, and where there are no members.
[[nodiscard]] control::GripResult overall_result(std::span<const control::GripResult> results,
                                                 std::uint32_t members) noexcept;

}  // namespace softgrip::daemon
