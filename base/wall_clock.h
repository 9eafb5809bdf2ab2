#pragma once
// The wall clock beside the monotonic one: for people and file names, never for control.

#include <string>

#include "base/time.h"

namespace softgrip {

/// What the wall clock showed, or will show, at a moment of the machine's clock (base/clock.h): nanoseconds
/// since 1970 (UTC). By what both clocks show now, so a clock that was set moves the past as well.
[[nodiscard]] Nanoseconds wall_time(Nanoseconds moment);
/// What it shows now.
[[nodiscard]] Nanoseconds wall_time_now();

/// "2025-11-20T03:46:12Z", with `decimals` (0 to 9) digits of the second behind a point. Texts with as many
/// decimals sort as their times do. Digits are cut, not rounded.
[[nodiscard]] std::string utc_text(Nanoseconds wall, int decimals = 0);

}  // namespace softgrip
