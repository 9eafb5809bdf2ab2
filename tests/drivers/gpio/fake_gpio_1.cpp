// Implements the functions of libgpiod 1.6 with the simulated chips of fake_gpio.h.

#include <gpiod.h>

#include <cerrno>

#include "tests/drivers/gpio/fake_gpio.h"

using softgrip::drivers::testing::FakeBias;
using softgrip::drivers::testing::FakeChip;
using softgrip::drivers::testing::FakeEdge;
using softgrip::drivers::testing::FakeLine;
using softgrip::drivers::testing::hold_fake_lines;

namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;

FakeChip& of(gpiod_chip* chip) {
  return *reinterpret_cast<FakeChip*>(chip);
}
FakeLine& of(gpiod_line* line) {
  return *reinterpret_cast<FakeLine*>(line);
}
gpiod_line* handle(FakeLine& line) {
  return reinterpret_cast<gpiod_line*>(&line);
}
int result(int error) {
  if (error == 0) return 0;
  errno = error;
  return -1;
}

FakeBias bias_of(int flags) {
  if ((flags & GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE) != 0) return FakeBias::disabled;
  if ((flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) != 0) return FakeBias::pull_up;
  if ((flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) != 0) return FakeBias::pull_down;
  return FakeBias::as_is;
}

}  // namespace

extern "C" {

gpiod_chip* gpiod_chip_open(const char* path) {
  return reinterpret_cast<gpiod_chip*>(softgrip::drivers::testing::open_fake_chip(path));
}
void gpiod_chip_close(gpiod_chip*) {}
const char* gpiod_chip_label(gpiod_chip* chip) {
  return of(chip).label.c_str();
}
unsigned gpiod_chip_num_lines(gpiod_chip* chip) {
  return static_cast<unsigned>(of(chip).lines.size());
}
gpiod_line* gpiod_chip_get_line(gpiod_chip* chip, unsigned offset) {
  return handle(of(chip).lines.at(offset));
}
const char* gpiod_line_name(gpiod_line* line) {
  return of(line).name.empty() ? nullptr : of(line).name.c_str();
}
const char* gpiod_line_consumer(gpiod_line* line) {
  return of(line).consumer.empty() ? nullptr : of(line).consumer.c_str();
}
bool gpiod_line_is_used(gpiod_line* line) {
  return of(line).used;
}
int gpiod_line_direction(gpiod_line* line) {
  return of(line).output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT;
}
int gpiod_line_request(gpiod_line* line, const gpiod_line_request_config* config, int default_value) {
  const bool output = config->request_type == GPIOD_LINE_REQUEST_DIRECTION_OUTPUT;
  const bool edges = config->request_type == GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
  const bool inverted = (config->flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0;
  const int error = of(line).request(config->consumer, output, edges, inverted, bias_of(config->flags));
  if (error == 0 && output) of(line).high = (default_value != 0) != inverted;
  return result(error);
}
void gpiod_line_release(gpiod_line* line) {
  of(line).release();
}
int gpiod_line_event_get_fd(gpiod_line* line) {
  return of(line).pipe[0];
}
int gpiod_line_get_value(gpiod_line* line) {
  const auto held = hold_fake_lines();
  return of(line).gone ? result(EIO) : static_cast<int>(of(line).active());
}
int gpiod_line_set_value(gpiod_line* line, int value) {
  const auto held = hold_fake_lines();
  if (of(line).gone) return result(EIO);
  of(line).high = (value != 0) != of(line).active_low;
  return 0;
}
int gpiod_line_event_read_multiple(gpiod_line* line, gpiod_line_event* events, unsigned most) {
  const auto held = hold_fake_lines();
  if (of(line).gone) return result(EIO);
  unsigned count = 0;
  for (; count < most && !of(line).edges.empty(); ++count) {
    const FakeEdge edge = of(line).take_edge();
    events[count].ts = {edge.at_ns / ns_per_s, edge.at_ns % ns_per_s};
    events[count].event_type = edge.rising ? GPIOD_LINE_EVENT_RISING_EDGE : GPIOD_LINE_EVENT_FALLING_EDGE;
  }
  return static_cast<int>(count);
}

}  // extern "C"
