#pragma once
// Where everything that keeps time takes it from, and sleeps by: the machine's monotonic clock, or one that
// only its owner moves.

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

/// CLOCK_MONOTONIC.
[[nodiscard]] Nanoseconds monotonic_now() noexcept;

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

}  // namespace softgrip
