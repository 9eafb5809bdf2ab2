// Accesses the GPIO character device through libgpiod. Debian 12 has version 1.6 of this library, and Debian
// 13 has version 2.x. libgpiod_1.h and libgpiod_2.h contain the code that differs between the two versions.

#include <gpiod.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/text.h"
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

/// Returns the description of a failure to open a chip or to request a line. The description contains a hint
/// for the author of the rig file.
Failure failed(const std::string& what, int error) {
  Failure failure{Failure::Kind::failed, 0, what + ": " + std::strerror(error), ""};
  if (error == EACCES || error == EPERM) {
    failure.hint =
        "the udev rule of the package gives the service access to the chips that are named in the rig file; "
        "after a change of the rig file, run `udevadm trigger --action=add --subsystem-match=gpio`";
  }
  return failure;
}

/// Returns the paths of the chips' files and of the links to these files, in alphabetical order.
std::vector<std::filesystem::path> chip_paths(const std::filesystem::path& devices) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(devices, error)) {
    if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Returns the chips with the words by which a rig file can select them. If chips could not be opened, sets
/// `denied` to the errno of the last failure.
std::vector<ComputerDevice> look_at_chips(const std::filesystem::path& devices,
                                          const std::filesystem::path& sys, int& denied) {
  std::vector<ComputerDevice> chips;
  for (const std::filesystem::path& path : chip_paths(devices)) {
    std::error_code error;
    const std::filesystem::path real = std::filesystem::canonical(path, error);
    const std::string node = (error ? path : real).filename().string();
    auto chip = std::find_if(chips.begin(), chips.end(),
                             [&](const ComputerDevice& known) { return known.node == node; });
    if (chip == chips.end()) {
      chip = chips.insert(chip, device_at(sys / "bus/gpio/devices" / node));
      const Chip opened(gpiod_chip_open(path.c_str()));
      if (!opened) denied = errno;
      const std::string label = opened ? libgpiod::label_of(opened.get()) : "";
      if (!label.empty()) chip->words.insert(chip->words.begin(), {"label", label});
    }
    if (path.filename() != node) chip->add("link", path.filename().string());
  }
  return chips;
}

tl::expected<Chip, Failure> open_chip(const std::filesystem::path& devices, const std::filesystem::path& sys,
                                      const std::string& wanted) {
  int denied = 0;
  const std::vector<ComputerDevice> there = look_at_chips(devices, sys, denied);
  const auto found = only_device(there, wanted, "GPIO chip");
  if (!found) {
    const bool none_opened = std::none_of(
        there.begin(), there.end(), [](const ComputerDevice& chip) { return !chip.word("label").empty(); });
    if (none_opened && denied != 0)
      return tl::unexpected(
          failed(found.error().message + ", and none of the GPIO chips can be opened", denied));
    return tl::unexpected(refused(found.error().message, found.error().hint));
  }
  Chip chip(gpiod_chip_open((devices / found->node).c_str()));
  if (!chip) return tl::unexpected(failed("the chip `" + wanted + "` cannot be opened", errno));
  return chip;
}

/// Returns the offsets of all lines of a chip that have the name `name`.
std::vector<std::uint32_t> offsets_of(gpiod_chip* chip, const std::string& name) {
  std::vector<std::uint32_t> offsets;
  for (std::uint32_t offset = 0; offset < libgpiod::lines_of(chip); ++offset) {
    const auto facts = libgpiod::facts_of(chip, offset);
    if (facts && facts->name == name) offsets.push_back(offset);
  }
  return offsets;
}

tl::expected<LineFacts, Failure> find_line(gpiod_chip* chip, const GpioLineSettings& settings) {
  std::optional<std::uint32_t> offset = settings.offset;
  if (!settings.line.empty()) {
    const std::vector<std::uint32_t> named = offsets_of(chip, settings.line);
    if (named.empty()) {
      return tl::unexpected(
          refused("the chip `" + settings.chip + "` has no line named `" + settings.line + "`",
                  "`gpioinfo` lists the lines and their names"));
    }
    if (named.size() > 1) {
      const auto number = [](std::uint32_t one) { return std::to_string(one); };
      return tl::unexpected(refused("the chip `" + settings.chip + "` has " + std::to_string(named.size()) +
                                        " lines named `" + settings.line +
                                        "`: " + enumerated(named, " and ", number),
                                    "write `offset` instead of `line`"));
    }
    offset = named.front();
  }
  const std::size_t lines = libgpiod::lines_of(chip);
  if (!offset || *offset >= lines) {
    return tl::unexpected(
        refused("the chip `" + settings.chip + "` has no line " + std::to_string(offset.value_or(0)),
                "the lines of this chip have the numbers 0 to " + std::to_string(lines - 1)));
  }
  auto facts = libgpiod::facts_of(chip, *offset);
  if (!facts) return tl::unexpected(failed("the state of the line cannot be read", errno));
  if (facts->used) {
    return tl::unexpected(Failure{
        Failure::Kind::failed, 0,
        "the line is in use" + (facts->consumer.empty() ? std::string{} : " by `" + facts->consumer + "`"),
        "another program or the kernel uses this line: `gpioinfo` shows its name"});
  }
  if (is_input(settings.role) && facts->output) {
    return tl::unexpected(refused(
        "the line is configured as an output, but `" + std::string(name_of(settings.role)) + "` is an input",
        "the rig file names a wrong line, or a program made the line an output; `gpioget` with this chip and "
        "line makes the line an input again"));
  }
  return *facts;
}

/// Returns the description of a failed request of a line. EINVAL, ENOTSUPP and similar errors mean that the
/// chip does not support the requested settings.
Failure request_failure(const GpioLineSettings& settings, int error) {
  if (error == EBUSY) return failed("the line is in use", error);
  if (error == EACCES) return failed("the line cannot be requested", error);
  constexpr int not_supported = 524;  // value of ENOTSUPP in the kernel; the C library does not define it
  const bool unable = error == EINVAL || error == EOPNOTSUPP || error == not_supported || error == EPERM ||
                      error == EIO || error == ENXIO;
  if (!unable) return failed("the line cannot be requested", error);
  return refused("the chip cannot make this line an " +
                     std::string(is_input(settings.role) ? "input" : "output") + " with these settings",
                 settings.bias == GpioBias::as_is
                     ? "the rig file names a wrong line, or the chip cannot change the direction of this line"
                     : "the chip cannot change the direction of this line, or does not support this `bias`");
}

class LibgpiodLines final : public GpioLines {
 public:
  tl::expected<void, Failure> add(const std::filesystem::path& devices, const std::filesystem::path& sys,
                                  const GpioLineSettings& settings) {
    auto chip = open_chip(devices, sys, settings.chip);
    if (!chip) return tl::unexpected(chip.error());
    const auto facts = find_line(chip->get(), settings);
    if (!facts) return tl::unexpected(facts.error());
    bool edges = is_input(settings.role);
    auto line = std::make_unique<Line>(chip->get(), settings, facts->offset, edges);
    if (!line->requested() && edges && (errno == ENXIO || errno == EOPNOTSUPP || errno == EINVAL)) {
      edges = false;  // the chip has no interrupts, so the levels of its lines are read, and no edges
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
        if (polled_[i].revents != 0) return std::nullopt;  // the chip was removed, so no edge can be read
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

  std::vector<Chip> chips_;  // declared before the member with the lines, because the lines must be destroyed
                             // before their chips
  std::array<std::unique_ptr<Line>, gpio_role_count> lines_;
  std::array<pollfd, gpio_role_count> polled_{};
  std::array<GpioRole, gpio_role_count> polled_roles_{};
  std::size_t polled_count_ = 0;
  bool sees_edges_ = true;
};

}  // namespace

std::string text_of(const GpioLineSettings& line) {
  std::string text = line.chip + " line ";
  text += line.line.empty() ? std::to_string(line.offset.value_or(0)) : "`" + line.line + "`";
  return text + (line.active_low ? ", active low" : ", active high");
}

std::vector<ComputerDevice> chips_in(const std::filesystem::path& devices, const std::filesystem::path& sys) {
  int denied = 0;
  return look_at_chips(devices, sys, denied);
}

tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines(
    std::span<const GpioLineSettings> lines) {
  return open_gpio_lines_in("/dev", "/sys", lines);
}

tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines_in(
    const std::filesystem::path& devices, const std::filesystem::path& sys,
    std::span<const GpioLineSettings> lines) {
  auto opened = std::make_unique<LibgpiodLines>();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto added = opened->add(devices, sys, lines[i]);
    if (added) continue;
    GpioFailure failure = added.error();
    failure.line = i;
    return tl::unexpected(std::move(failure));
  }
  return opened;
}

}  // namespace softgrip::drivers
