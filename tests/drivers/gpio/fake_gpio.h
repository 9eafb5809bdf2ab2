#pragma once
// Simulated GPIO chips. fake_gpio_1.cpp and fake_gpio_2.cpp implement the functions of libgpiod that the
// driver calls, one file per version of the library. These functions use the chips of fake_chips(). Test
// programs are linked with these functions instead of libgpiod.

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace softgrip::drivers::testing {

enum class FakeBias : std::uint8_t { as_is, disabled, pull_up, pull_down };

struct FakeEdge {
  bool rising = false;
  std::int64_t at_ns = 0;
};

struct FakeLine {
  std::string name;
  bool used = false;  ///< true: the driver or another program uses the line
  std::string consumer;
  bool output = false;
  bool high = false;        ///< physical level of the line; true: high
  bool edges_seen = false;  ///< true: the line was requested with edge detection
  bool active_low = false;
  FakeBias bias = FakeBias::as_is;
  bool gone = false;  ///< true: the chip was removed, so every call fails with EIO
  int pipe[2] = {-1, -1};
  std::deque<FakeEdge> edges;

  [[nodiscard]] bool active() const { return high != active_low; }
  /// Changes the level of the line. If the line was requested with edge detection, adds an edge with the time
  /// `at_ns` to the queue of the line.
  void change(bool to_high, std::int64_t at_ns);
  /// Requests the line for a program. Returns 0 or an errno.
  int request(const std::string& by, bool as_output, bool with_edges, bool inverted, FakeBias resistor);
  void release();
  /// Removes the oldest edge from the queue of the line and returns it.
  FakeEdge take_edge();
};

struct FakeChip {
  std::string name;  ///< name of the chip, for example "gpiochip0"
  std::string label;
  int open_error = 0;      ///< errno for a failed attempt to open the chip; 0: opening succeeds
  bool interrupts = true;  ///< true: the chip supports interrupts; false: a request with edge detection fails
                           ///< with ENXIO
  std::vector<FakeLine> lines;
};

/// Locks all lines. A test must hold this lock while it changes levels and the driver runs in another thread.
/// The simulated functions of libgpiod take the same lock.
[[nodiscard]] std::unique_lock<std::recursive_mutex> hold_fake_lines();
/// Returns the simulated chips of the machine. Each test must clear this list.
std::vector<FakeChip>& fake_chips();
/// Returns the chip at this path. If no chip has this path, sets errno and returns nullptr.
FakeChip* open_fake_chip(const char* path);
/// Returns true if the chip to which the line belongs supports interrupts.
bool has_interrupts(const FakeLine& line);

}  // namespace softgrip::drivers::testing
