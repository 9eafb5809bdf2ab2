#pragma once
// Simulated GPIO chips. fake_gpio_1.cpp and fake_gpio_2.cpp implement the functions of libgpiod that the
// driver calls, one file per version of the library. They operate on the chips of fake_chips() and replace
// the functions of the library when a test program is linked.

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
  bool used = false;  ///< the line is in use, by the driver or by another program
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
  /// Changes the level of the line. If the line was requested with edge detection, an edge at the time
  /// `at_ns` waits for the program.
  void change(bool to_high, std::int64_t at_ns);
  /// Requests the line for a program. Returns 0 or an errno.
  int request(const std::string& by, bool as_output, bool with_edges, bool inverted, FakeBias resistor);
  void release();
  /// Returns the edge of the line that has waited longest, and removes it.
  FakeEdge take_edge();
};

struct FakeChip {
  std::string name;  ///< name of the chip, for example "gpiochip0"
  std::string label;
  int open_error = 0;      ///< errno with which opening the chip fails; 0: opening succeeds
  bool interrupts = true;  ///< true: the chip supports interrupts; false: a request with edge detection fails
                           ///< with ENXIO
  std::vector<FakeLine> lines;
};

/// Locks all lines. A test that changes levels while the driver runs in another thread must hold this lock.
/// The replaced functions of libgpiod hold the lock as well.
[[nodiscard]] std::unique_lock<std::recursive_mutex> hold_fake_lines();
/// Returns the simulated chips of the machine. Each test must clear the list.
std::vector<FakeChip>& fake_chips();
/// Returns the chip at this path. If there is none, sets errno and returns nullptr.
FakeChip* open_fake_chip(const char* path);
/// Returns true if the chip to which the line belongs supports interrupts.
bool has_interrupts(const FakeLine& line);

}  // namespace softgrip::drivers::testing
