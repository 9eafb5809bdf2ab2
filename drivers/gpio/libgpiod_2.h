#pragma once
// Accesses the library libgpiod 2.x: https://git.kernel.org/pub/scm/libs/libgpiod/libgpiod.git, v2.x,
// include/gpiod.h

#include <gpiod.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/clock.h"
#include "drivers/gpio/gpio_lines.h"
#include "drivers/gpio/libgpiod.h"

namespace softgrip::drivers::libgpiod {

template <auto Free>
struct FreeBy {
  template <class T>
  void operator()(T* thing) const noexcept {
    Free(thing);
  }
};
using LineConfig = std::unique_ptr<gpiod_line_config, FreeBy<gpiod_line_config_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, FreeBy<gpiod_line_settings_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, FreeBy<gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, FreeBy<gpiod_line_request_release>>;
using EdgeBuffer = std::unique_ptr<gpiod_edge_event_buffer, FreeBy<gpiod_edge_event_buffer_free>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, FreeBy<gpiod_chip_info_free>>;
using LineInfo = std::unique_ptr<gpiod_line_info, FreeBy<gpiod_line_info_free>>;

inline std::string label_of(gpiod_chip* chip) {
  const ChipInfo info(gpiod_chip_get_info(chip));
  return info ? gpiod_chip_info_get_label(info.get()) : "";
}

inline std::size_t lines_of(gpiod_chip* chip) {
  const ChipInfo info(gpiod_chip_get_info(chip));
  return info ? gpiod_chip_info_get_num_lines(info.get()) : 0;
}

inline std::optional<LineFacts> facts_of(gpiod_chip* chip, std::uint32_t offset) {
  const LineInfo info(gpiod_chip_get_line_info(chip, offset));
  if (!info) return std::nullopt;
  const char* const by = gpiod_line_info_get_consumer(info.get());
  const char* const name = gpiod_line_info_get_name(info.get());
  return LineFacts{offset, gpiod_line_info_is_used(info.get()),
                   gpiod_line_info_get_direction(info.get()) == GPIOD_LINE_DIRECTION_OUTPUT,
                   by == nullptr ? "" : by, name == nullptr ? "" : name};
}

inline gpiod_line_bias bias_of(GpioBias bias) {
  switch (bias) {
    case GpioBias::as_is:
      return GPIOD_LINE_BIAS_AS_IS;
    case GpioBias::disabled:
      return GPIOD_LINE_BIAS_DISABLED;
    case GpioBias::pull_up:
      return GPIOD_LINE_BIAS_PULL_UP;
    case GpioBias::pull_down:
      return GPIOD_LINE_BIAS_PULL_DOWN;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

/// A line after a successful request. Each line has a request of its own. Therefore, a failed request affects
/// only one line.
class Line {
 public:
  Line(gpiod_chip* chip, const GpioLineSettings& settings, std::uint32_t offset, bool edges)
      : offset_(offset) {
    const Settings line(gpiod_line_settings_new());
    const LineConfig config(gpiod_line_config_new());
    const RequestConfig request(gpiod_request_config_new());
    if (!line || !config || !request) return;
    const bool input = is_input(settings.role);
    gpiod_line_settings_set_direction(line.get(),
                                      input ? GPIOD_LINE_DIRECTION_INPUT : GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_active_low(line.get(), settings.active_low);
    gpiod_line_settings_set_bias(line.get(), bias_of(settings.bias));
    if (edges) gpiod_line_settings_set_edge_detection(line.get(), GPIOD_LINE_EDGE_BOTH);
    if (!input) gpiod_line_settings_set_output_value(line.get(), GPIOD_LINE_VALUE_INACTIVE);
    gpiod_request_config_set_consumer(request.get(), consumer);
    if (gpiod_line_config_add_line_settings(config.get(), &offset_, 1, line.get()) != 0) return;
    if (edges) buffer_ = EdgeBuffer(gpiod_edge_event_buffer_new(edges_at_once));
    request_ = Request(gpiod_chip_request_lines(chip, request.get(), config.get()));
  }

  [[nodiscard]] bool requested() const noexcept { return request_ != nullptr; }
  [[nodiscard]] int descriptor() const noexcept { return gpiod_line_request_get_fd(request_.get()); }
  [[nodiscard]] std::optional<bool> level() const noexcept {
    const gpiod_line_value value = gpiod_line_request_get_value(request_.get(), offset_);
    if (value == GPIOD_LINE_VALUE_ERROR) return std::nullopt;
    return value == GPIOD_LINE_VALUE_ACTIVE;
  }
  [[nodiscard]] bool set(bool active) const noexcept {
    return gpiod_line_request_set_value(request_.get(), offset_,
                                        active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
  }
  /// Reads the edges that the kernel has stored. Returns nothing if reading fails. The caller must first wait
  /// until the descriptor is readable.
  [[nodiscard]] std::optional<std::size_t> edges(GpioRole role, std::span<GpioEdge> to) const noexcept {
    const std::size_t most = std::min(to.size(), edges_at_once);
    const int count = gpiod_line_request_read_edge_events(request_.get(), buffer_.get(), most);
    if (count < 0) return std::nullopt;
    const Nanoseconds asleep = time_asleep();
    for (int i = 0; i < count; ++i) {
      gpiod_edge_event* const event =
          gpiod_edge_event_buffer_get_event(buffer_.get(), static_cast<unsigned long>(i));
      to[static_cast<std::size_t>(i)] = {
          role, gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
          static_cast<Nanoseconds>(gpiod_edge_event_get_timestamp_ns(event)) + asleep};
    }
    return static_cast<std::size_t>(count);
  }

 private:
  std::uint32_t offset_;
  EdgeBuffer buffer_;
  Request request_;
};

}  // namespace softgrip::drivers::libgpiod
