#include "tests/drivers/gpio/fake_gpio.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace softgrip::drivers::testing {

std::unique_lock<std::recursive_mutex> hold_fake_lines() {
  static std::recursive_mutex lines;
  return std::unique_lock(lines);
}

std::vector<FakeChip>& fake_chips() {
  static std::vector<FakeChip> chips;
  return chips;
}

FakeChip* open_fake_chip(const char* path) {
  const std::string name = std::filesystem::path(path).filename().string();
  for (FakeChip& chip : fake_chips()) {
    if (chip.name != name) continue;
    if (chip.open_error == 0) return &chip;
    errno = chip.open_error;
    return nullptr;
  }
  errno = ENOENT;
  return nullptr;
}

bool has_interrupts(const FakeLine& line) {
  for (const FakeChip& chip : fake_chips()) {
    for (const FakeLine& one : chip.lines) {
      if (&one == &line) return chip.interrupts;
    }
  }
  return false;
}

void FakeLine::change(bool to_high, std::int64_t at_ns) {
  if (to_high == high) return;
  high = to_high;
  if (!edges_seen) return;
  edges.push_back({active(), at_ns});
  const char one = 1;
  if (::write(pipe[1], &one, 1) != 1) gone = true;
}

int FakeLine::request(const std::string& by, bool as_output, bool with_edges, bool inverted,
                      FakeBias resistor) {
  if (used) return EBUSY;
  if (with_edges && !has_interrupts(*this)) return ENXIO;
  if (with_edges && ::pipe(pipe) != 0) return errno;
  used = true;
  consumer = by;
  output = as_output;
  edges_seen = with_edges;
  active_low = inverted;
  bias = resistor;
  if (as_output) high = inverted;  // after a request as an output, the line has its inactive level
  return 0;
}

void FakeLine::release() {
  for (int& end : pipe) {
    if (end >= 0) ::close(end);
    end = -1;
  }
  used = false;
  consumer.clear();
  edges_seen = false;
}

FakeEdge FakeLine::take_edge() {
  char one = 0;
  if (::read(pipe[0], &one, 1) != 1) gone = true;
  const FakeEdge edge = edges.front();
  edges.pop_front();
  return edge;
}

}  // namespace softgrip::drivers::testing
