#pragma once
// The wall clock, for messages and file names, never for control.

#include <string>

#include "base/time.h"

namespace softgrip {

/// Converts a time of the machine's clock (base/clock.h) to nanoseconds since 1970 (UTC). Uses the present
/// difference of the clocks, so setting the wall clock also changes the result for past times.
[[nodiscard]] Nanoseconds wall_time(Nanoseconds moment);
/// Returns the present time of the wall clock.
[[nodiscard]] Nanoseconds wall_time_now();

/// Returns "2025-11-20T03:46:12Z" with `decimals` (0 to 9) decimal places of the second. Texts with equal
/// decimals sort in the order of time. Digits are truncated, not rounded.
[[nodiscard]] std::string utc_text(Nanoseconds wall, int decimals = 0);

}  // namespace softgrip
