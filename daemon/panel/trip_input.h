#pragma once
// An input that stops the rig. It trips if the level is doubtful, and clears only after the level has been
// steady.

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// Debounces one input, using edges with the kernel's times and levels that are read periodically. Either
/// source would be sufficient: edges are faster, and levels cannot be lost. Starts tripped.
///
///   trips   when the line has been at its trip level for `debounce` without interruption, and at most
///           2 `debounce` after the first edge to it, even if the line bounces. A disturbance shorter than
///           `debounce` does not trip.
///   clears  when the line has been clear for `debounce` without interruption
class TripInput {
 public:
  explicit TripInput(Nanoseconds debounce) noexcept : debounce_(debounce) {}

  /// Processes an edge: the line changed to the trip level (`trips`) or from it at `at`.
  void edge(bool trips, Nanoseconds at) noexcept;
  /// Processes a read level: the line is now at the trip level (`trips`) or not.
  void level(bool trips, Nanoseconds now) noexcept;

  [[nodiscard]] bool tripped() const noexcept { return tripped_; }
  /// Returns the time at which level() must be called next if no edge arrives; INT64_MAX if no change is
  /// pending.
  [[nodiscard]] Nanoseconds due() const noexcept;

 private:
  static constexpr Nanoseconds never = INT64_MAX;
  void settle(Nanoseconds now) noexcept;
  void change(bool trips, Nanoseconds at) noexcept;

  Nanoseconds debounce_;
  bool tripped_ = true;
  bool known_ = false;           // the level has been read at least once
  bool asks_ = true;             // the line is at its trip level ...
  Nanoseconds since_ = 0;        // ... and has been steady since this time
  Nanoseconds suspect_ = never;  // while the input is clear: time of the first change since the line was last
                                 // steady
};

}  // namespace softgrip::daemon
