#pragma once
// The periodic schedule of a thread, with absolute deadlines.

#include <cerrno>
#include <cstdint>
#include <ctime>

#include "base/time.h"

namespace softgrip {

/// Ticks lie at start + k * period. After an overrun, the next tick is the next one of the schedule: missed
/// ticks are not repeated in a burst, and the phase is kept.
class PeriodicSchedule {
 public:
  PeriodicSchedule(Nanoseconds start, Nanoseconds period) noexcept : period_(period), due_(start) {}

  [[nodiscard]] Nanoseconds period() const noexcept { return period_; }
  /// When the current tick was or is due.
  [[nodiscard]] Nanoseconds due() const noexcept { return due_; }

  /// Moves on to the first tick that is not yet over at `now`; returns how many were skipped.
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

/// Returns at `due` of CLOCK_BOOTTIME or later, never before.
inline void sleep_until(Nanoseconds due) noexcept {
  // Not std::this_thread::sleep_until: libstdc++ 12 turns it into a relative sleep, which drifts.
  const timespec time{due / ns_per_s, due % ns_per_s};
  while (clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace softgrip
