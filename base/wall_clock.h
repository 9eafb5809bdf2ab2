#pragma once
// Reads the wall clock for messages and file names. No control function uses this clock.

#include <string>

#include "base/time.h"

namespace softgrip {

/// Converts a time of the machine's clock (base/clock.h) to nanoseconds since 1970 (UTC). The conversion uses
/// the present difference between the machine's clock and the wall clock. Therefore, setting the wall clock
/// also changes the results for past times.
[[nodiscard]] Nanoseconds wall_time(Nanoseconds moment);
/// Returns the present time of the wall clock.
[[nodiscard]] Nanoseconds wall_time_now();

/// Returns a time as text, such as "2025-11-20T03:46:12Z". The seconds have `decimals` (0 to 9) decimal
/// places; further places are cut off and not rounded. The alphabetical order of texts with equally many
/// decimals is the order of the times.
[[nodiscard]] std::string utc_text(Nanoseconds wall, int decimals = 0);

}  // namespace softgrip
