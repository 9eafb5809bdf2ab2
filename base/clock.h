#pragma once
// Defines the clocks. All times in the project come from CLOCK_BOOTTIME of the machine or from the virtual
// clock of a test.

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

/// Returns the time of CLOCK_BOOTTIME. This clock cannot be set. Unlike CLOCK_MONOTONIC, it also runs while
/// the machine is suspended. The board's watchdog runs during this time too, so the daemon must see the
/// pause.
[[nodiscard]] Nanoseconds monotonic_now() noexcept;

/// The clock that monotonic_now() reads, for functions that accept any Clock.
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

/// Returns the total time for which the machine was suspended: the difference of CLOCK_BOOTTIME and
/// CLOCK_MONOTONIC, in whole milliseconds [ns]. It is needed because the kernel gives the times of edges on
/// CLOCK_MONOTONIC.
[[nodiscard]] Nanoseconds time_asleep() noexcept;

}  // namespace softgrip
