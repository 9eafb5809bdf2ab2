#pragma once
// Computes the absolute deadlines of a thread that runs periodically.

#include <cerrno>
#include <cstdint>
#include <ctime>

#include "base/time.h"

namespace softgrip {

/// Ticks are due at start + k * period. After an overrun, the schedule continues with the next regular tick.
/// Missed ticks are not repeated, and the later deadlines remain at start + k * period.
class PeriodicSchedule {
 public:
  PeriodicSchedule(Nanoseconds start, Nanoseconds period) noexcept : period_(period), due_(start) {}

  [[nodiscard]] Nanoseconds period() const noexcept { return period_; }
  /// Returns the time at which the current tick is due.
  [[nodiscard]] Nanoseconds due() const noexcept { return due_; }

  /// Advances to the next tick. If this tick was due before `now`, advances to the first tick that is due at
  /// or after `now`. Returns the number of skipped ticks.
  std::uint64_t advance(Nanoseconds now) noexcept {
    due_ += period_;
    if (now <= due_) return 0;
    const Nanoseconds skipped = (now - due_ + period_ - 1) / period_;
    due_ += skipped * period_;
    return static_cast<std::uint64_t>(skipped);
  }

 private:
  Nanoseconds period_;
  Nanoseconds due_;
};

/// Waits until `due` on CLOCK_BOOTTIME and returns at that time or later, never earlier.
inline void sleep_until(Nanoseconds due) noexcept {
  // std::this_thread::sleep_until() of libstdc++ 12 sleeps for a relative time, so its errors add up to a
  // drift.
  const timespec time{due / ns_per_s, due % ns_per_s};
  while (clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace softgrip
