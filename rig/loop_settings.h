#pragma once
// Timing of the loop and of the bus thread.

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "base/time.h"

namespace softgrip::rig {

/// The rate itself stands in control::RigSettings: one number for controller and loop.
///
///   tick k                        tick k+1
///   |-- loop computes --|         |
///   |<-- bus_offset -->|-- exchange --|
///
/// The loop never wakes the bus thread (that would be a system call in a tick): each sleeps on its own
/// absolute grid of the same period, the bus thread's `bus_offset` behind. A command therefore reaches the
/// board bus_offset plus the outward half of an exchange after its tick, and a reading is period - bus_offset
/// old when the next tick uses it.
struct LoopSettings {
  /// Fraction of the period by which the bus thread's grid lags the loop's, above 0 and below 1.
  double bus_offset_fraction = 0.25;
  /// Longest duration of one exchange [s]; a slower board is a timeout and its session is rebuilt. It may be
  /// longer than the period: an exchange that overruns its grid is a slip of the bus, the readings get older,
  /// and the controller judges their age.
  double exchange_deadline_s = 0.05;
  /// Exchanges without a new command from the loop after which the bus thread writes the safe outputs by
  /// itself.
  std::uint32_t max_missed_commands = 10;
};

/// A gap between exchanges that comes so close to the time of the board's watchdog counts as one that has
/// reached it: an exchange may take until its deadline to reach the board. At most half of the watchdog's
/// time.
[[nodiscard]] inline std::chrono::nanoseconds watchdog_margin(const LoopSettings& loop,
                                                              std::chrono::nanoseconds watchdog) noexcept {
  return std::min(std::chrono::nanoseconds(nanoseconds(loop.exchange_deadline_s)), watchdog / 2);
}

/// Rebuilding a lost session, in the bus thread.
struct ReconnectSettings {
  std::chrono::nanoseconds connect_deadline = std::chrono::milliseconds(500);
  std::chrono::nanoseconds first_pause = std::chrono::milliseconds(100);
  /// The pause doubles after each failed attempt up to this.
  std::chrono::nanoseconds longest_pause = std::chrono::seconds(5);
};

}  // namespace softgrip::rig
