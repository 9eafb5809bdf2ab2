#pragma once
// Settings for the timing of the loop and of the bus thread.

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "base/time.h"

namespace softgrip::rig {

/// Settings for the timing of the loop and of the bus thread. The rate of the loop is a member of
/// control::RigSettings, because the controller needs it too.
///
///   tick k                        tick k+1
///   |-- loop computes --|         |
///   |<-- bus_offset -->|-- exchange --|
///
/// The loop never wakes the bus thread, because this would need a system call in a tick. Each of the two
/// threads has a periodic schedule with absolute times, and both have the same period. The schedule of the
/// bus thread is `bus_offset` later than the schedule of the loop. Therefore, a command reaches the board
/// bus_offset plus half an exchange after its tick. When the next tick uses a reading, the age of the reading
/// is the period minus bus_offset. rig/rig_keys.cpp declares the meaning and the range of each member.
struct LoopSettings {
  double bus_offset_fraction = 0.25;
  /// Longest duration of one exchange [s]. If the board needs more time, the exchange times out and the
  /// session is opened again. The duration may exceed the period of the bus thread. An exchange that takes
  /// longer than the period is an overrun of the bus thread. The readings of such an exchange are older than
  /// usual, and the controller checks their age.
  double exchange_deadline_s = 0.05;
  std::uint32_t max_missed_commands = 10;
};

/// Returns the safety margin of the board's watchdog time [ns]. If a gap between exchanges is longer than the
/// watchdog time minus this margin, the daemon assumes that the watchdog has tripped. The margin is needed
/// because a request may reach the board just before the deadline of its exchange. The margin is at most half
/// of the watchdog time.
[[nodiscard]] inline std::chrono::nanoseconds watchdog_margin(const LoopSettings& loop,
                                                              std::chrono::nanoseconds watchdog) noexcept {
  return std::min(std::chrono::nanoseconds(nanoseconds(loop.exchange_deadline_s)), watchdog / 2);
}

/// Settings for the attempts of the bus thread to reopen a lost session.
struct ReconnectSettings {
  std::chrono::nanoseconds connect_deadline = std::chrono::milliseconds(500);
  std::chrono::nanoseconds first_pause = std::chrono::milliseconds(100);
  /// Longest pause between two attempts [ns]. The pause doubles after each failed attempt, up to this value.
  std::chrono::nanoseconds longest_pause = std::chrono::seconds(5);
};

}  // namespace softgrip::rig
