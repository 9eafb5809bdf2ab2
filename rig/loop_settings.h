#pragma once
// Timing of the loop and of the bus thread.

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "base/time.h"

namespace softgrip::rig {

/// Timing of the loop and of the bus thread. The loop rate is a member of control::RigSettings, because the
/// controller needs it too.
///
///   tick k                        tick k+1
///   |-- loop computes --|         |
///   |<-- bus_offset -->|-- exchange --|
///
/// The loop never wakes the bus thread, because that would need a system call in a tick. Each thread has a
/// periodic schedule of the same period with absolute times. The bus thread runs `bus_offset` later than the
/// loop. A command therefore reaches the board bus_offset plus half an exchange after its tick. A reading has
/// the age period - bus_offset when the next tick uses it.
struct LoopSettings {
  /// Delay of the bus thread's schedule after that of the loop, as a fraction of the period; above 0 and
  /// below 1.
  double bus_offset_fraction = 0.25;
  /// Longest duration of one exchange [s]. If the board is slower, the exchange times out and the session is
  /// opened again. The duration may exceed the period. An exchange that is longer than the period is an
  /// overrun of the bus thread. Its readings are older, and the controller checks the age of readings.
  double exchange_deadline_s = 0.05;
  /// Number of exchanges without a new command from the loop after which the bus thread writes the safe
  /// outputs.
  std::uint32_t max_missed_commands = 10;
};

/// Returns the safety margin of the board's watchdog time [ns]. If a gap between exchanges is longer than the
/// watchdog time minus this margin, the daemon assumes that the watchdog has tripped, because a request may
/// reach the board as late as the deadline of its exchange. The margin is at most half of the watchdog time.
[[nodiscard]] inline std::chrono::nanoseconds watchdog_margin(const LoopSettings& loop,
                                                              std::chrono::nanoseconds watchdog) noexcept {
  return std::min(std::chrono::nanoseconds(nanoseconds(loop.exchange_deadline_s)), watchdog / 2);
}

/// Timing of the attempts of the bus thread to open a lost session again.
struct ReconnectSettings {
  std::chrono::nanoseconds connect_deadline = std::chrono::milliseconds(500);
  std::chrono::nanoseconds first_pause = std::chrono::milliseconds(100);
  /// The pause doubles after each failed attempt, up to this value.
  std::chrono::nanoseconds longest_pause = std::chrono::seconds(5);
};

}  // namespace softgrip::rig
