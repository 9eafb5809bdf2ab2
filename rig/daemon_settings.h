#pragma once
// Settings for the timing of the loop and of the bus thread.
// The settings in the `real_time` map of a rig file, which the daemon requests from the operating system.
// The settings in the `recorder` map of a rig file: contents, folder and write intervals of recordings.
// The settings in the `socket` map of a rig file: the Unix domain sockets of the daemon.
// The settings in the `gpio` map of a rig file: the digital lines and their functions.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/enum_table.h"
#include "base/time.h"
#include "document/problem.h"
#include "drivers/gpio/gpio_lines.h"

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

/// The map `real_time` of a rig file. rig/rig_keys.cpp declares the meaning and the range of each member.
struct RealTimeSettings {
  bool required = false;
  int priority = 70;
  /// If true, the daemon locks its present and future pages with mlockall(). It also does not return heap
  /// memory to the kernel, and does not use mmap() for large blocks.
  bool lock_memory = true;
  std::size_t prefault_stack_bytes = 256 * 1024;
  std::size_t prefault_heap_bytes = 8 * 1024 * 1024;
  /// The value is written to /dev/cpu_dma_latency; if it is empty, nothing is written.
  std::optional<int> cpu_dma_latency_us;
  std::vector<int> cpus;
};

/// The map `recorder` of a rig file. rig/rig_keys.cpp declares the meaning and the range of each member.
struct RecorderSettings {
  enum class Mode : std::uint8_t {
    off,
    sequences,  ///< one folder per sequence, and one folder per fault, which begins with the rows from before
                ///< the fault
    always,     ///< one folder for the complete time from the start to the end of the daemon
  };
  Mode mode = Mode::sequences;
  /// Folder in which the daemon creates one folder per recording.
  std::string directory = "/var/lib/softgrip/runs";
  std::uint32_t decimation = 1;
  double flush_interval_s = 0.1;
  double sync_interval_s = 5;
  double history_s = 1;
};
inline constexpr auto recorder_mode_names =
    enum_names<RecorderSettings::Mode>({{RecorderSettings::Mode::off, "off"},
                                        {RecorderSettings::Mode::sequences, "sequences"},
                                        {RecorderSettings::Mode::always, "always"}});

/// The file of a Unix domain stream socket.
struct SocketFile {
  std::string path;  ///< path of the socket file; empty: there is no such socket
  /// Permissions of the socket file (file mode).
  unsigned mode = 0660;
  /// Group of the socket file; empty: the group of the daemon.
  std::string group;
};

/// The socket for clients that may move the gripper, and the settings for both sockets. rig/rig_keys.cpp
/// declares the meaning and the range of each member.
struct SocketSettings : SocketFile {
  SocketSettings() { path = "/run/softgrip/softgripd.sock"; }
  /// The socket for read-only clients.
  SocketFile look;
  std::size_t max_clients = 16;
  std::size_t max_line_bytes = 64 * 1024;
  std::size_t max_queue_bytes = 1024 * 1024;
  /// Folder with the sequences that clients can start by name.
  std::string sequence_directory = "/etc/softgrip/sequences";
};

/// The map `gpio` of a rig file. rig/rig_keys.cpp declares the meaning and the range of each member.
struct GpioSettings {
  double debounce_s = 0;
  double stale_after_s = 0;
  double look_interval_s = 0.005;
  /// True: the enable output stays on while a fault is latched. An emergency stop, lost input lines and a
  /// stalled control loop switch it off in any case.
  bool keeps_enable_on_fault = false;
  std::vector<drivers::GpioLineSettings> lines;  ///< settings of the digital lines; at most one line for each
                                                 ///< purpose
  std::vector<document::Problem> places;  ///< location of each line in the rig file, stored as a problem
                                          ///< without a message

  [[nodiscard]] bool has(drivers::GpioRole role) const noexcept {
    for (const drivers::GpioLineSettings& line : lines) {
      if (line.role == role) return true;
    }
    return false;
  }
};

}  // namespace softgrip::rig
