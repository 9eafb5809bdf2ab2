// The GPIO character device through libgpiod: the only file that includes its header. Debian 12 has the API
// of 1.6, Debian 13 the one of 2.x, which shares its names but nothing else; SOFTGRIP_GPIOD_2 chooses.
//
// 1.6: https://git.kernel.org/pub/scm/libs/libgpiod/libgpiod.git, v1.6.x, include/gpiod.h
// 2.x: the same, v2.x, include/gpiod.h

#include <gpiod.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "drivers/gpio/gpio_lines.h"

namespace softgrip::drivers {

namespace {

constexpr const char* consumer = "softgripd";
/// Edges taken from one line at once; the kernel keeps 16 per line.
constexpr std::size_t edges_at_once = 16;
constexpr Nanoseconds ns_per_s = 1'000'000'000;

/// What the kernel knows of a line.
struct LineFacts {
  std::uint32_t offset = 0;
  bool used = false;
  bool output = false;
  std::string consumer;
};

using Failure = GpioFailure;

Failure refused(std::string message, std::string hint = {}) {
  return {Failure::Kind::refused, 0, std::move(message), std::move(hint)};
}

/// What an errno of opening or requesting means to who wrote the rig file.
Failure failed(const std::string& what, int error) {
  Failure failure{Failure::Kind::failed, 0, what + ": " + std::strerror(error), ""};
  if (error == EACCES || error == EPERM) {
    failure.hint =
        "/dev/gpiochip* must be readable and writable for this user: see the udev rule of the package";
  }
  return failure;
}

// What both APIs do under different names. A chip is open as long as its handle lives.
struct CloseChip {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

#if SOFTGRIP_GPIOD_2

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

std::string label_of(gpiod_chip* chip) {
  const ChipInfo info(gpiod_chip_get_info(chip));
  return info ? gpiod_chip_info_get_label(info.get()) : "";
}

std::size_t lines_of(gpiod_chip* chip) {
  const ChipInfo info(gpiod_chip_get_info(chip));
  return info ? gpiod_chip_info_get_num_lines(info.get()) : 0;
}

std::optional<std::uint32_t> offset_of(gpiod_chip* chip, const std::string& name) {
  const int offset = gpiod_chip_get_line_offset_from_name(chip, name.c_str());
  return offset < 0 ? std::nullopt : std::optional<std::uint32_t>(static_cast<std::uint32_t>(offset));
}

std::optional<LineFacts> facts_of(gpiod_chip* chip, std::uint32_t offset) {
  const LineInfo info(gpiod_chip_get_line_info(chip, offset));
  if (!info) return std::nullopt;
  const char* const by = gpiod_line_info_get_consumer(info.get());
  return LineFacts{offset, gpiod_line_info_is_used(info.get()),
                   gpiod_line_info_get_direction(info.get()) == GPIOD_LINE_DIRECTION_OUTPUT,
                   by == nullptr ? "" : by};
}

gpiod_line_bias bias_of(GpioBias bias) {
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

/// A line that was requested. 2.x: a request of one line each, so that each has its own failure.
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
  /// Edges that wait; nothing on failure. Called when the descriptor is readable.
  [[nodiscard]] std::optional<std::size_t> edges(GpioRole role, std::span<GpioEdge> to) const noexcept {
    const std::size_t most = std::min(to.size(), edges_at_once);
    const int count = gpiod_line_request_read_edge_events(request_.get(), buffer_.get(), most);
    if (count < 0) return std::nullopt;
    for (int i = 0; i < count; ++i) {
      gpiod_edge_event* const event =
          gpiod_edge_event_buffer_get_event(buffer_.get(), static_cast<unsigned long>(i));
      to[static_cast<std::size_t>(i)] = {
          role, gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
          static_cast<Nanoseconds>(gpiod_edge_event_get_timestamp_ns(event))};
    }
    return static_cast<std::size_t>(count);
  }

 private:
  std::uint32_t offset_;
  EdgeBuffer buffer_;
  Request request_;
};

#else

std::string label_of(gpiod_chip* chip) {
  return gpiod_chip_label(chip);
}

std::size_t lines_of(gpiod_chip* chip) {
  return gpiod_chip_num_lines(chip);
}

std::optional<std::uint32_t> offset_of(gpiod_chip* chip, const std::string& name) {
  gpiod_line* const line = gpiod_chip_find_line(chip, name.c_str());
  if (line == nullptr) return std::nullopt;
  return gpiod_line_offset(line);
}

std::optional<LineFacts> facts_of(gpiod_chip* chip, std::uint32_t offset) {
  gpiod_line* const line = gpiod_chip_get_line(chip, offset);
  if (line == nullptr) return std::nullopt;
  const char* const by = gpiod_line_consumer(line);
  return LineFacts{offset, gpiod_line_is_used(line),
                   gpiod_line_direction(line) == GPIOD_LINE_DIRECTION_OUTPUT, by == nullptr ? "" : by};
}

int flags_of(const GpioLineSettings& settings) {
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

/// A line that was requested. 1.6: it belongs to its chip, which stays open as long.
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
  /// Edges that wait; nothing on failure. Called when the descriptor is readable.
  [[nodiscard]] std::optional<std::size_t> edges(GpioRole role, std::span<GpioEdge> to) const noexcept {
    std::array<gpiod_line_event, edges_at_once> events{};
    const auto most = static_cast<unsigned>(std::min(to.size(), edges_at_once));
    const int count = gpiod_line_event_read_multiple(line_.get(), events.data(), most);
    if (count < 0) return std::nullopt;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const timespec& at = events[i].ts;
      to[i] = {role, events[i].event_type == GPIOD_LINE_EVENT_RISING_EDGE,
               Nanoseconds{at.tv_sec} * ns_per_s + at.tv_nsec};
    }
    return static_cast<std::size_t>(count);
  }

 private:
  struct Release {
    void operator()(gpiod_line* line) const noexcept { gpiod_line_release(line); }
  };
  std::unique_ptr<gpiod_line, Release> line_;
};

#endif

/// The chips of this machine, by name.
std::vector<std::filesystem::path> chip_paths() {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

tl::expected<Chip, Failure> open_chip(const std::string& wanted) {
  Chip by_label;
  std::string there;
  int denied = 0;
  for (const std::filesystem::path& path : chip_paths()) {
    Chip chip(gpiod_chip_open(path.c_str()));
    const std::string name = path.filename().string();
    if (!chip) {
      if (name == wanted) return tl::unexpected(failed("the chip `" + wanted + "` cannot be opened", errno));
      denied = errno;
      continue;
    }
    if (name == wanted) return chip;
    const std::string label = label_of(chip.get());
    there += (there.empty() ? "" : ", ") + name + " (" + label + ")";
    if (label != wanted) continue;
    if (by_label) {
      return tl::unexpected(
          refused("two chips of this machine have the label `" + wanted + "`", "name the chip: " + there));
    }
    by_label = std::move(chip);
  }
  if (by_label) return by_label;
  const std::string what = "no GPIO chip of this machine is called `" + wanted + "`";
  if (there.empty() && denied != 0) return tl::unexpected(failed(what + ", and none can be opened", denied));
  return tl::unexpected(refused(what, there.empty() ? "it has none at all" : "it has " + there));
}

tl::expected<LineFacts, Failure> find_line(gpiod_chip* chip, const GpioLineSettings& settings) {
  std::optional<std::uint32_t> offset = settings.offset;
  if (!settings.line.empty()) {
    offset = offset_of(chip, settings.line);
    if (!offset) {
      return tl::unexpected(
          refused("the chip `" + settings.chip + "` has no line named `" + settings.line + "`",
                  "`gpioinfo` lists the lines and their names"));
    }
  }
  const std::size_t lines = lines_of(chip);
  if (!offset || *offset >= lines) {
    return tl::unexpected(
        refused("the chip `" + settings.chip + "` has no line " + std::to_string(offset.value_or(0)),
                "its lines count from 0 to " + std::to_string(lines - 1)));
  }
  auto facts = facts_of(chip, *offset);
  if (!facts) return tl::unexpected(failed("the line cannot be looked at", errno));
  if (facts->used) {
    return tl::unexpected(Failure{
        Failure::Kind::failed, 0,
        "the line is in use" + (facts->consumer.empty() ? std::string{} : " by `" + facts->consumer + "`"),
        "another program, or the kernel itself, holds it: `gpioinfo` shows who"});
  }
  if (is_input(settings.role) && facts->output) {
    return tl::unexpected(
        refused("the line is an output now, and `" + std::string(name_of(settings.role)) + "` is an input",
                "another line is meant, or a program left it so: `gpioget` with this chip and line makes it "
                "an input"));
  }
  return *facts;
}

/// EINVAL, ENOTSUPP ... of a request: the chip cannot do that with this line.
Failure request_failure(const GpioLineSettings& settings, int error) {
  if (error == EBUSY) return failed("the line is in use", error);
  if (error == EACCES) return failed("the line cannot be requested", error);
  constexpr int not_supported = 524;  // ENOTSUPP of the kernel, which libc does not know
  const bool unable = error == EINVAL || error == EOPNOTSUPP || error == not_supported || error == EPERM ||
                      error == EIO || error == ENXIO;
  if (!unable) return failed("the line cannot be requested", error);
  return refused("the chip cannot make this line an " +
                     std::string(is_input(settings.role) ? "input" : "output") + " as described",
                 settings.bias == GpioBias::as_is ? "another line is meant, or its direction is fixed"
                                                  : "its direction is fixed, or it has no such `bias`");
}

class LibgpiodLines final : public GpioLines {
 public:
  tl::expected<void, Failure> add(const GpioLineSettings& settings) {
    auto chip = open_chip(settings.chip);
    if (!chip) return tl::unexpected(chip.error());
    const auto facts = find_line(chip->get(), settings);
    if (!facts) return tl::unexpected(facts.error());
    bool edges = is_input(settings.role);
    auto line = std::make_unique<Line>(chip->get(), settings, facts->offset, edges);
    if (!line->requested() && edges && (errno == ENXIO || errno == EOPNOTSUPP || errno == EINVAL)) {
      edges = false;  // a chip without interrupts: its levels are read all the same
      line = std::make_unique<Line>(chip->get(), settings, facts->offset, edges);
    }
    if (!line->requested()) return tl::unexpected(request_failure(settings, errno));
    if (is_input(settings.role)) {
      sees_edges_ = sees_edges_ && edges;
      if (edges) {
        polled_[polled_count_] = {line->descriptor(), POLLIN, 0};
        polled_roles_[polled_count_++] = settings.role;
      }
    }
    chips_.push_back(std::move(*chip));
    lines_[static_cast<std::size_t>(settings.role)] = std::move(line);
    return {};
  }

  std::optional<std::size_t> wait(Nanoseconds timeout, std::span<GpioEdge> edges) noexcept override {
    const timespec time{timeout / ns_per_s, timeout % ns_per_s};
    const int ready = ::ppoll(polled_.data(), polled_count_, &time, nullptr);
    if (ready < 0 && errno != EINTR) return std::nullopt;
    std::size_t count = 0;
    for (std::size_t i = 0; ready > 0 && i < polled_count_; ++i) {
      if ((polled_[i].revents & POLLIN) == 0) {
        if (polled_[i].revents != 0) return std::nullopt;  // the chip is gone
        continue;
      }
      if (count == edges.size()) break;
      const auto taken = line(polled_roles_[i])->edges(polled_roles_[i], edges.subspan(count));
      if (!taken) return std::nullopt;
      count += *taken;
    }
    return count;
  }

  std::optional<bool> read(GpioRole role) noexcept override {
    const Line* const to = line(role);
    return to == nullptr ? std::nullopt : to->level();
  }

  bool write(GpioRole role, bool active) noexcept override {
    const Line* const to = line(role);
    return to == nullptr || to->set(active);
  }

  [[nodiscard]] bool sees_edges() const noexcept override { return sees_edges_; }

 private:
  [[nodiscard]] const Line* line(GpioRole role) const noexcept {
    return lines_[static_cast<std::size_t>(role)].get();
  }

  std::vector<Chip> chips_;  // before the lines, which go first
  std::array<std::unique_ptr<Line>, gpio_role_count> lines_;
  std::array<pollfd, gpio_role_count> polled_{};
  std::array<GpioRole, gpio_role_count> polled_roles_{};
  std::size_t polled_count_ = 0;
  bool sees_edges_ = true;
};

}  // namespace

tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines(
    std::span<const GpioLineSettings> lines) {
  auto opened = std::make_unique<LibgpiodLines>();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto added = opened->add(lines[i]);
    if (added) continue;
    GpioFailure failure = added.error();
    failure.line = i;
    return tl::unexpected(std::move(failure));
  }
  return opened;
}

}  // namespace softgrip::drivers
