#pragma once
// GPIO chips without a kernel: the functions of libgpiod that the driver calls, for the API of the installed
// library (fake_gpio_1.cpp, fake_gpio_2.cpp), over the chips that stand here. They take the place of the
// library's own when a test program is linked.

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
  bool used = false;  ///< by the driver, too, while it holds the line
  std::string consumer;
  bool output = false;
  bool high = false;        ///< what a voltmeter shows
  bool edges_seen = false;  ///< requested with edge detection
  bool active_low = false;
  FakeBias bias = FakeBias::as_is;
  bool gone = false;  ///< every call fails with EIO
  int pipe[2] = {-1, -1};
  std::deque<FakeEdge> edges;

  [[nodiscard]] bool active() const { return high != active_low; }
  /// The level changes, and the kernel says so to who asked for edges.
  void change(bool to_high, std::int64_t at_ns);
  /// What a request does. 0, or its errno.
  int request(const std::string& by, bool as_output, bool with_edges, bool inverted, FakeBias resistor);
  void release();
  /// Takes the next edge that waits.
  FakeEdge take_edge();
};

struct FakeChip {
  std::string name;  ///< "gpiochip0"
  std::string label;
  int open_error = 0;      ///< errno of opening it
  bool interrupts = true;  ///< without them a request with edges fails with ENXIO
  std::vector<FakeLine> lines;
};

/// Whoever changes levels in another thread than the driver's holds this meanwhile; the library's functions
/// do.
[[nodiscard]] std::unique_lock<std::recursive_mutex> hold_fake_lines();
/// The machine's chips. Emptied by the tests.
std::vector<FakeChip>& fake_chips();
/// The chip whose file is opened; nullptr, and errno, if that fails.
FakeChip* open_fake_chip(const char* path);
/// Of the line's chip.
bool has_interrupts(const FakeLine& line);

}  // namespace softgrip::drivers::testing
