#pragma once
// An input that stops something: trips on doubt, clears only when it has been steady.

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// Debounces one input from edges with the kernel's times and from levels read now and then; either alone
/// would do, edges are faster and levels cannot be lost. Tripped from the start.
///
///   trips   when the line was at its trip level for `debounce` without a break, and at the latest
///           2 `debounce` after the first edge to it, even if the line chatters. A disturbance shorter than
///           `debounce` does not trip.
///   clears  when the line has been steadily clear for `debounce`
class TripInput {
 public:
  explicit TripInput(Nanoseconds debounce) noexcept : debounce_(debounce) {}

  /// The line changed to `trips` at `at`.
  void edge(bool trips, Nanoseconds at) noexcept;
  /// The line is `trips` now.
  void level(bool trips, Nanoseconds now) noexcept;

  [[nodiscard]] bool tripped() const noexcept { return tripped_; }
  /// When level() should be called next if nothing happens until then; far away if nothing is pending.
  [[nodiscard]] Nanoseconds due() const noexcept;

 private:
  static constexpr Nanoseconds never = INT64_MAX;
  void settle(Nanoseconds now) noexcept;
  void change(bool trips, Nanoseconds at) noexcept;

  Nanoseconds debounce_;
  bool tripped_ = true;
  bool known_ = false;           // the line was looked at
  bool asks_ = true;             // the line's present wish to trip ...
  Nanoseconds since_ = 0;        // ... and since when it is steady
  Nanoseconds suspect_ = never;  // while clear: since when it was not steadily clear
};

}  // namespace softgrip::daemon
