#pragma once
// Defines the clocks. All times of control, and all times in logs, come from CLOCK_BOOTTIME of the machine or
// from a virtual clock, in tests and in runs in virtual time. The wall clock is read only for messages and
// file names.

#include <algorithm>
#include <string>

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
  /// Waits until `due`. Returns at `due` or later, never earlier than `due`.
  virtual void sleep_until(Nanoseconds due) const noexcept = 0;
};

/// Returns the time of CLOCK_BOOTTIME. This clock cannot be set. Like the watchdog of the board, the clock
/// runs while the machine is suspended. Therefore, the daemon can detect a suspension. CLOCK_MONOTONIC stops
/// during a suspension.
[[nodiscard]] Nanoseconds monotonic_now() noexcept;

/// A clock that returns the time of monotonic_now(), for functions with an argument of type Clock.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override;
  void sleep_until(Nanoseconds due) const noexcept override;
};

/// A clock for tests and for runs in virtual time. Its time changes only by set(), advance() and
/// sleep_until(). sleep_until() returns at once.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override { return now_; }
  void sleep_until(Nanoseconds due) const noexcept override { now_ = std::max(now_, due); }
  void set(Nanoseconds now) noexcept { now_ = now; }
  void advance(Nanoseconds duration) noexcept { now_ += duration; }

 private:
  mutable Nanoseconds now_ = 0;
};

/// Returns the total time for which the machine was suspended [ns], rounded to whole milliseconds. This time
/// is the difference of CLOCK_BOOTTIME and CLOCK_MONOTONIC. The kernel gives the times of GPIO edges on
/// CLOCK_MONOTONIC; adding this difference converts them to CLOCK_BOOTTIME.
[[nodiscard]] Nanoseconds time_asleep() noexcept;

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
