#pragma once
// Clocks: all time in the project comes from CLOCK_BOOTTIME of the machine or from a virtual clock of a test.

#include <algorithm>

#include "base/time.h"

namespace softgrip {

class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  Clock(Clock&&) = delete;
  Clock& operator=(Clock&&) = delete;
  virtual ~Clock() = default;
  [[nodiscard]] virtual Nanoseconds now() const noexcept = 0;
  /// Returns at `due` or later, never earlier.
  virtual void sleep_until(Nanoseconds due) const noexcept = 0;
};

/// Returns CLOCK_BOOTTIME. It cannot be set and, unlike CLOCK_MONOTONIC, it counts while the machine is
/// suspended. The board's watchdog also counts during that time, so the daemon must see the pause.
[[nodiscard]] Nanoseconds monotonic_now() noexcept;

/// The clock monotonic_now() for functions that also accept another clock.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override;
  void sleep_until(Nanoseconds due) const noexcept override;
};

/// A clock that changes only when it is set. sleep_until() sets it to the end of the sleep.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override { return now_; }
  void sleep_until(Nanoseconds due) const noexcept override { now_ = std::max(now_, due); }
  void set(Nanoseconds now) noexcept { now_ = now; }
  void advance(Nanoseconds duration) noexcept { now_ += duration; }

 private:
  mutable Nanoseconds now_ = 0;
};

/// Returns the time by which CLOCK_BOOTTIME is ahead of CLOCK_MONOTONIC, in whole milliseconds [ns]: the
/// total time in suspend. The kernel stamps edges with CLOCK_MONOTONIC.
[[nodiscard]] Nanoseconds time_asleep() noexcept;

}  // namespace softgrip
