#pragma once
// Accesses the library libgpiod 1.6: https://git.kernel.org/pub/scm/libs/libgpiod/libgpiod.git, v1.6.x,
// include/gpiod.h

#include <gpiod.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/clock.h"
#include "drivers/gpio/gpio_lines.h"
#include "drivers/gpio/libgpiod.h"

namespace softgrip::drivers::libgpiod {

inline std::string label_of(gpiod_chip* chip) {
  return gpiod_chip_label(chip);
}

inline std::size_t lines_of(gpiod_chip* chip) {
  return gpiod_chip_num_lines(chip);
}

inline std::optional<LineFacts> facts_of(gpiod_chip* chip, std::uint32_t offset) {
  gpiod_line* const line = gpiod_chip_get_line(chip, offset);
  if (line == nullptr) return std::nullopt;
  const char* const by = gpiod_line_consumer(line);
  const char* const name = gpiod_line_name(line);
  return LineFacts{offset, gpiod_line_is_used(line),
                   gpiod_line_direction(line) == GPIOD_LINE_DIRECTION_OUTPUT, by == nullptr ? "" : by,
                   name == nullptr ? "" : name};
}

inline int flags_of(const GpioLineSettings& settings) {
  int flags = settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  switch (settings.bias) {
    case GpioBias::as_is:
      break;
    case GpioBias::disabled:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
      break;
    case GpioBias::pull_up:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
      break;
    case GpioBias::pull_down:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
      break;
  }
  return flags;
}

/// A line after a successful request. In libgpiod 1.6, a line belongs to its chip. Therefore, the chip must
/// remain open while the line is used.
class Line {
 public:
  Line(gpiod_chip* chip, const GpioLineSettings& settings, std::uint32_t offset, bool edges) {
    gpiod_line* const line = gpiod_chip_get_line(chip, offset);
    if (line == nullptr) return;
    int request = GPIOD_LINE_REQUEST_DIRECTION_OUTPUT;
    if (is_input(settings.role)) {
      request = edges ? GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES : GPIOD_LINE_REQUEST_DIRECTION_INPUT;
    }
    const gpiod_line_request_config config{consumer, request, flags_of(settings)};
    if (gpiod_line_request(line, &config, 0) == 0) line_.reset(line);
  }

  [[nodiscard]] bool requested() const noexcept { return line_ != nullptr; }
  [[nodiscard]] int descriptor() const noexcept { return gpiod_line_event_get_fd(line_.get()); }
  [[nodiscard]] std::optional<bool> level() const noexcept {
    const int value = gpiod_line_get_value(line_.get());
    return value < 0 ? std::nullopt : std::optional<bool>(value == 1);
  }
  [[nodiscard]] bool set(bool active) const noexcept {
    return gpiod_line_set_value(line_.get(), active ? 1 : 0) == 0;
  }
  /// Reads the edges that the kernel has stored. Returns nothing if reading fails. The caller must first wait
  /// until the descriptor is readable.
  [[nodiscard]] std::optional<std::size_t> edges(GpioRole role, std::span<GpioEdge> to) const noexcept {
    std::array<gpiod_line_event, edges_at_once> events{};
    const auto most = static_cast<unsigned>(std::min(to.size(), edges_at_once));
    const int count = gpiod_line_event_read_multiple(line_.get(), events.data(), most);
    if (count < 0) return std::nullopt;
    const Nanoseconds asleep = time_asleep();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const timespec& at = events[i].ts;
      to[i] = {role, events[i].event_type == GPIOD_LINE_EVENT_RISING_EDGE,
               Nanoseconds{at.tv_sec} * ns_per_s + at.tv_nsec + asleep};
    }
    return static_cast<std::size_t>(count);
  }

 private:
  struct Release {
    void operator()(gpiod_line* line) const noexcept { gpiod_line_release(line); }
  };
  std::unique_ptr<gpiod_line, Release> line_;
};

}  // namespace softgrip::drivers::libgpiod
