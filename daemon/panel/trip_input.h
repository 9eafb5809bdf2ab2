#pragma once
// A digital input whose trip stops the rig. If the level of the line is uncertain, the input trips. The input
// clears only after the line has had its clear level for the debounce time.

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// Debounces one input. It uses edges with the kernel's times, and levels that are read periodically. Each of
/// the two sources would be sufficient: edges arrive faster, and levels cannot be lost. The input starts
/// tripped.
///
///   trips   when the line has been at its trip level for `debounce` without interruption. The input also
///           trips if the line has not been steady for 2 `debounce` after its first edge. A disturbance that
///           is shorter than `debounce` does not trip the input.
///   clears  when the line has been at its clear level for `debounce` without interruption
class TripInput {
 public:
  explicit TripInput(Nanoseconds debounce) noexcept : debounce_(debounce) {}

  /// Processes an edge at the time `at`. If `trips` is true, the line changed to its trip level, otherwise to
  /// its clear level.
  void edge(bool trips, Nanoseconds at) noexcept;
  /// Processes a level that was read. If `trips` is true, the line is now at its trip level, otherwise at its
  /// clear level.
  void level(bool trips, Nanoseconds now) noexcept;

  [[nodiscard]] bool tripped() const noexcept { return tripped_; }
  /// Returns the time at which level() must be called if no edge arrives before that time; INT64_MAX if no
  /// change is pending.
  [[nodiscard]] Nanoseconds due() const noexcept;

 private:
  static constexpr Nanoseconds never = INT64_MAX;
  void settle(Nanoseconds now) noexcept;
  void change(bool trips, Nanoseconds at) noexcept;

  Nanoseconds debounce_;
  bool tripped_ = true;
  bool known_ = false;           // true: the level has been read at least once
  bool asks_ = true;             // true: the line is at its trip level
  Nanoseconds since_ = 0;        // time since which the line has had its present level
  Nanoseconds suspect_ = never;  // time of the first edge since the line was last steady; valid while the
                                 // input is clear
};

}  // namespace softgrip::daemon
