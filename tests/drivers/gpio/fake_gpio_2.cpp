// Implements the functions of libgpiod 2.x with the simulated chips of fake_gpio.h.

#include <gpiod.h>

#include <array>
#include <cerrno>

#include "tests/drivers/gpio/fake_gpio.h"

using softgrip::drivers::testing::FakeBias;
using softgrip::drivers::testing::FakeChip;
using softgrip::drivers::testing::FakeEdge;
using softgrip::drivers::testing::FakeLine;
using softgrip::drivers::testing::hold_fake_lines;

// Types that the header of the library declares but does not define.
struct gpiod_chip {
  FakeChip* chip;
};
struct gpiod_chip_info {
  FakeChip* chip;
};
struct gpiod_line_info {
  FakeLine* line;
};
struct gpiod_line_settings {
  gpiod_line_direction direction = GPIOD_LINE_DIRECTION_AS_IS;
  gpiod_line_edge edges = GPIOD_LINE_EDGE_NONE;
  gpiod_line_bias bias = GPIOD_LINE_BIAS_AS_IS;
  gpiod_line_value value = GPIOD_LINE_VALUE_INACTIVE;
  bool active_low = false;
};
struct gpiod_line_config {
  unsigned offset = 0;
  gpiod_line_settings settings;
};
struct gpiod_request_config {
  std::string consumer;
};
struct gpiod_line_request {
  FakeLine* line;
  unsigned offset;
};
struct gpiod_edge_event {
  FakeEdge edge;
};
struct gpiod_edge_event_buffer {
  std::array<gpiod_edge_event, 16> events;
};

namespace {

int result(int error) {
  if (error == 0) return 0;
  errno = error;
  return -1;
}

FakeBias bias_of(gpiod_line_bias bias) {
  if (bias == GPIOD_LINE_BIAS_DISABLED) return FakeBias::disabled;
  if (bias == GPIOD_LINE_BIAS_PULL_UP) return FakeBias::pull_up;
  if (bias == GPIOD_LINE_BIAS_PULL_DOWN) return FakeBias::pull_down;
  return FakeBias::as_is;
}

}  // namespace

extern "C" {

gpiod_chip* gpiod_chip_open(const char* path) {
  FakeChip* const chip = softgrip::drivers::testing::open_fake_chip(path);
  return chip == nullptr ? nullptr : new gpiod_chip{chip};
}
void gpiod_chip_close(gpiod_chip* chip) {
  delete chip;
}
gpiod_chip_info* gpiod_chip_get_info(gpiod_chip* chip) {
  return new gpiod_chip_info{chip->chip};
}
void gpiod_chip_info_free(gpiod_chip_info* info) {
  delete info;
}
const char* gpiod_chip_info_get_label(gpiod_chip_info* info) {
  return info->chip->label.c_str();
}
size_t gpiod_chip_info_get_num_lines(gpiod_chip_info* info) {
  return info->chip->lines.size();
}
gpiod_line_info* gpiod_chip_get_line_info(gpiod_chip* chip, unsigned offset) {
  return new gpiod_line_info{&chip->chip->lines.at(offset)};
}
void gpiod_line_info_free(gpiod_line_info* info) {
  delete info;
}
bool gpiod_line_info_is_used(gpiod_line_info* info) {
  return info->line->used;
}
const char* gpiod_line_info_get_name(gpiod_line_info* info) {
  return info->line->name.empty() ? nullptr : info->line->name.c_str();
}
const char* gpiod_line_info_get_consumer(gpiod_line_info* info) {
  return info->line->consumer.empty() ? nullptr : info->line->consumer.c_str();
}
gpiod_line_direction gpiod_line_info_get_direction(gpiod_line_info* info) {
  return info->line->output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT;
}

gpiod_line_settings* gpiod_line_settings_new() {
  return new gpiod_line_settings;
}
void gpiod_line_settings_free(gpiod_line_settings* settings) {
  delete settings;
}
int gpiod_line_settings_set_direction(gpiod_line_settings* settings, gpiod_line_direction direction) {
  settings->direction = direction;
  return 0;
}
int gpiod_line_settings_set_edge_detection(gpiod_line_settings* settings, gpiod_line_edge edges) {
  settings->edges = edges;
  return 0;
}
int gpiod_line_settings_set_bias(gpiod_line_settings* settings, gpiod_line_bias bias) {
  settings->bias = bias;
  return 0;
}
void gpiod_line_settings_set_active_low(gpiod_line_settings* settings, bool active_low) {
  settings->active_low = active_low;
}
int gpiod_line_settings_set_output_value(gpiod_line_settings* settings, gpiod_line_value value) {
  settings->value = value;
  return 0;
}
gpiod_line_config* gpiod_line_config_new() {
  return new gpiod_line_config;
}
void gpiod_line_config_free(gpiod_line_config* config) {
  delete config;
}
int gpiod_line_config_add_line_settings(gpiod_line_config* config, const unsigned* offsets, size_t count,
                                        gpiod_line_settings* settings) {
  if (count != 1) return result(EINVAL);
  *config = {*offsets, *settings};
  return 0;
}
gpiod_request_config* gpiod_request_config_new() {
  return new gpiod_request_config;
}
void gpiod_request_config_free(gpiod_request_config* config) {
  delete config;
}
void gpiod_request_config_set_consumer(gpiod_request_config* config, const char* consumer) {
  config->consumer = consumer;
}
gpiod_line_request* gpiod_chip_request_lines(gpiod_chip* chip, gpiod_request_config* request,
                                             gpiod_line_config* config) {
  FakeLine& line = chip->chip->lines.at(config->offset);
  const gpiod_line_settings& settings = config->settings;
  const bool output = settings.direction == GPIOD_LINE_DIRECTION_OUTPUT;
  const int error = line.request(request->consumer, output, settings.edges == GPIOD_LINE_EDGE_BOTH,
                                 settings.active_low, bias_of(settings.bias));
  if (result(error) != 0) return nullptr;
  if (output) line.high = (settings.value == GPIOD_LINE_VALUE_ACTIVE) != settings.active_low;
  return new gpiod_line_request{&line, config->offset};
}
void gpiod_line_request_release(gpiod_line_request* request) {
  request->line->release();
  delete request;
}
int gpiod_line_request_get_fd(gpiod_line_request* request) {
  return request->line->pipe[0];
}
gpiod_line_value gpiod_line_request_get_value(gpiod_line_request* request, unsigned offset) {
  const auto held = hold_fake_lines();
  if (result(request->line->gone || offset != request->offset ? EIO : 0) != 0) return GPIOD_LINE_VALUE_ERROR;
  return request->line->active() ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
}
int gpiod_line_request_set_value(gpiod_line_request* request, unsigned offset, gpiod_line_value value) {
  const auto held = hold_fake_lines();
  if (request->line->gone || offset != request->offset) return result(EIO);
  request->line->high = (value == GPIOD_LINE_VALUE_ACTIVE) != request->line->active_low;
  return 0;
}
gpiod_edge_event_buffer* gpiod_edge_event_buffer_new(size_t) {
  return new gpiod_edge_event_buffer;
}
void gpiod_edge_event_buffer_free(gpiod_edge_event_buffer* buffer) {
  delete buffer;
}
int gpiod_line_request_read_edge_events(gpiod_line_request* request, gpiod_edge_event_buffer* buffer,
                                        size_t most) {
  const auto held = hold_fake_lines();
  if (request->line->gone) return result(EIO);
  std::size_t count = 0;
  for (; count < most && !request->line->edges.empty(); ++count) {
    buffer->events.at(count).edge = request->line->take_edge();
  }
  return static_cast<int>(count);
}
gpiod_edge_event* gpiod_edge_event_buffer_get_event(gpiod_edge_event_buffer* buffer, unsigned long index) {
  return &buffer->events.at(index);
}
gpiod_edge_event_type gpiod_edge_event_get_event_type(gpiod_edge_event* event) {
  return event->edge.rising ? GPIOD_EDGE_EVENT_RISING_EDGE : GPIOD_EDGE_EVENT_FALLING_EDGE;
}
uint64_t gpiod_edge_event_get_timestamp_ns(gpiod_edge_event* event) {
  return static_cast<std::uint64_t>(event->edge.at_ns);
}

}  // extern "C"
