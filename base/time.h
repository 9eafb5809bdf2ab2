#pragma once
// Defines the time type of the project: whole nanoseconds.

#include <cmath>
#include <cstdint>

namespace softgrip {

/// A time or a duration in nanoseconds. Times are on CLOCK_BOOTTIME, or on a virtual clock.
using Nanoseconds = std::int64_t;

inline constexpr Nanoseconds ns_per_s = 1'000'000'000;

/// Converts nanoseconds to seconds. The division gives the nearest double. A multiplication by 1e-9 can give
/// a different double, such as 13.120000000000001 in place of 13.12.
[[nodiscard]] constexpr double seconds(Nanoseconds duration) noexcept {
  return static_cast<double>(duration) / 1e9;
}
[[nodiscard]] inline Nanoseconds nanoseconds(double duration_s) noexcept {
  return std::llround(duration_s * 1e9);
}

}  // namespace softgrip
