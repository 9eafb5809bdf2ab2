#pragma once
// Where everything that keeps time takes it from, and sleeps by: the machine's clock since it was booted, or
// one that only its owner moves.

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
  /// Returns at `due` or later, never before.
  virtual void sleep_until(Nanoseconds due) const noexcept = 0;
};

/// CLOCK_BOOTTIME: never set, and, unlike CLOCK_MONOTONIC, it goes on while the machine sleeps. To a board,
/// whose watchdog vents meanwhile, a lid that was closed is a pause like any other.
[[nodiscard]] Nanoseconds monotonic_now() noexcept;

/// monotonic_now() for whoever may be given another clock.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override;
  void sleep_until(Nanoseconds due) const noexcept override;
};

/// Stands still until it is set; who sleeps by it sets it.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override { return now_; }
  void sleep_until(Nanoseconds due) const noexcept override { now_ = std::max(now_, due); }
  void set(Nanoseconds now) noexcept { now_ = now; }
  void advance(Nanoseconds duration) noexcept { now_ += duration; }

 private:
  mutable Nanoseconds now_ = 0;
};

/// How far MonotonicClock is ahead of CLOCK_MONOTONIC, by which the kernel stamps edges: for how long the
/// machine has slept, in whole milliseconds.
[[nodiscard]] Nanoseconds time_asleep() noexcept;

}  // namespace softgrip
