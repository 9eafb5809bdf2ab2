#pragma once
// Simulated GPIO chips. The functions of libgpiod that the driver calls are implemented for the API of the
// installed library (fake_gpio_1.cpp, fake_gpio_2.cpp). They operate on the chips of fake_chips() and replace
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
  bool high = false;        ///< the physical level
  bool edges_seen = false;  ///< the line was requested with edge detection
  bool active_low = false;
  FakeBias bias = FakeBias::as_is;
  bool gone = false;  ///< every call fails with EIO
  int pipe[2] = {-1, -1};
  std::deque<FakeEdge> edges;

  [[nodiscard]] bool active() const { return high != active_low; }
  /// Changes the level. If the line was requested with edge detection, the program receives an edge.
  void change(bool to_high, std::int64_t at_ns);
  /// Requests the line. Returns 0 or an errno.
  int request(const std::string& by, bool as_output, bool with_edges, bool inverted, FakeBias resistor);
  void release();
  /// Returns the next waiting edge and removes it.
  FakeEdge take_edge();
};

struct FakeChip {
  std::string name;  ///< "gpiochip0"
  std::string label;
  int open_error = 0;      ///< errno when the chip is opened; 0: success
  bool interrupts = true;  ///< false: a request with edge detection fails with ENXIO
  std::vector<FakeLine> lines;
};

/// Locks all lines. A test that changes levels while the driver runs in another thread must hold the lock, as
/// the functions of the library do.
[[nodiscard]] std::unique_lock<std::recursive_mutex> hold_fake_lines();
/// Returns the chips of the machine. Each test clears the list.
std::vector<FakeChip>& fake_chips();
/// Returns the chip at this path, or nullptr with errno set.
FakeChip* open_fake_chip(const char* path);
/// Returns true if the line's chip supports interrupts.
bool has_interrupts(const FakeLine& line);

}  // namespace softgrip::drivers::testing
