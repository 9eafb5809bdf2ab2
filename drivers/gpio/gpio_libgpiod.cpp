// The GPIO character device through libgpiod. Debian 12 has the API of 1.6, Debian 13 the one of 2.x, which
// shares its names but nothing else: what differs stands in libgpiod_1.h and libgpiod_2.h.

#include <gpiod.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "drivers/gpio/gpio_chip.h"
#include "drivers/gpio/gpio_lines.h"
#if SOFTGRIP_GPIOD_2
#include "drivers/gpio/libgpiod_2.h"
#else
#include "drivers/gpio/libgpiod_1.h"
#endif

namespace softgrip::drivers {

namespace {

using libgpiod::Chip;
using libgpiod::Line;
using libgpiod::LineFacts;
using libgpiod::ns_per_s;
using Failure = GpioFailure;

Failure refused(std::string message, std::string hint = {}) {
  return {Failure::Kind::refused, 0, std::move(message), std::move(hint)};
}

/// What an errno of opening or requesting means to who wrote the rig file.
Failure failed(const std::string& what, int error) {
  Failure failure{Failure::Kind::failed, 0, what + ": " + std::strerror(error), ""};
  if (error == EACCES || error == EPERM) {
    failure.hint =
        "the package's udev rule gives the service the chips that its rig file names; after a change: "
        "`udevadm trigger --action=add --subsystem-match=gpio`";
  }
  return failure;
}

/// The chips of this machine, by name.
std::vector<std::filesystem::path> chip_paths(const std::filesystem::path& devices) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(devices, error)) {
    if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

tl::expected<Chip, Failure> open_chip(const std::filesystem::path& devices, const std::string& wanted) {
  Chip by_label;
  std::string there;
  int denied = 0;
  for (const std::filesystem::path& path : chip_paths(devices)) {
    Chip chip(gpiod_chip_open(path.c_str()));
    const std::string name = path.filename().string();
    if (!chip) {
      if (name == wanted) return tl::unexpected(failed("the chip `" + wanted + "` cannot be opened", errno));
      denied = errno;
      continue;
    }
    if (name == wanted) return chip;
    const std::string label = libgpiod::label_of(chip.get());
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
    offset = libgpiod::offset_of(chip, settings.line);
    if (!offset) {
      return tl::unexpected(
          refused("the chip `" + settings.chip + "` has no line named `" + settings.line + "`",
                  "`gpioinfo` lists the lines and their names"));
    }
  }
  const std::size_t lines = libgpiod::lines_of(chip);
  if (!offset || *offset >= lines) {
    return tl::unexpected(
        refused("the chip `" + settings.chip + "` has no line " + std::to_string(offset.value_or(0)),
                "its lines count from 0 to " + std::to_string(lines - 1)));
  }
  auto facts = libgpiod::facts_of(chip, *offset);
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
  tl::expected<void, Failure> add(const std::filesystem::path& devices, const GpioLineSettings& settings) {
    auto chip = open_chip(devices, settings.chip);
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

bool is_chip(const std::filesystem::path& device, const std::string& wanted) {
  if (device.filename() == wanted) return true;
  const Chip chip(gpiod_chip_open(device.c_str()));
  return chip && libgpiod::label_of(chip.get()) == wanted;
}

tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines(
    std::span<const GpioLineSettings> lines) {
  return open_gpio_lines_in("/dev", lines);
}

tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines_in(
    const std::filesystem::path& devices, std::span<const GpioLineSettings> lines) {
  auto opened = std::make_unique<LibgpiodLines>();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto added = opened->add(devices, lines[i]);
    if (added) continue;
    GpioFailure failure = added.error();
    failure.line = i;
    return tl::unexpected(std::move(failure));
  }
  return opened;
}

}  // namespace softgrip::drivers
