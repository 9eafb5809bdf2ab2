#pragma once
// Computes the absolute deadlines of a thread that runs periodically.

#include <cerrno>
#include <cstdint>
#include <ctime>

#include "base/time.h"

namespace softgrip {

/// A schedule whose ticks are due at start + k * period, k = 0, 1, 2, ... After an overrun, the schedule
/// continues with the next regular tick. Missed ticks are not repeated, and the deadlines after the overrun
/// remain at start + k * period.
class PeriodicSchedule {
 public:
  PeriodicSchedule(Nanoseconds start, Nanoseconds period) noexcept : period_(period), due_(start) {}

  [[nodiscard]] Nanoseconds period() const noexcept { return period_; }
  /// Returns the time at which the current tick is due.
  [[nodiscard]] Nanoseconds due() const noexcept { return due_; }

  /// Advances to the next tick. If the next tick was due before `now`, advances to the first tick that is due
  /// at or after `now`. Returns the number of skipped ticks.
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

/// Waits until `due` on CLOCK_BOOTTIME. Returns at `due` or later, never earlier than `due`.
inline void sleep_until(Nanoseconds due) noexcept {
  // std::this_thread::sleep_until() is not used, because in libstdc++ 12 this function sleeps for a relative
  // time. The errors of relative times add up to a drift.
  const timespec time{due / ns_per_s, due % ns_per_s};
  while (clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace softgrip
