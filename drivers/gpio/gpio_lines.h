#pragma once
// Defines the interface for the digital lines of a rig: buttons, lamps and an enable output.
// daemon/panel/panel.h uses the interface. drivers/gpio/gpio_libgpiod.cpp implements the interface with the
// GPIO character device. The tests have an implementation of their own.
// Finds the GPIO chips of this computer.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/computer_device.h"
#include "base/enum_table.h"
#include "model/reading.h"

namespace softgrip::drivers {

/// The purpose of a line. A rig has at most one line for each purpose.
enum class GpioRole : std::uint8_t { emergency_stop, part_in_position, enable, ready_lamp, fault_lamp };
/// Names of the purposes in rig files.
inline constexpr auto gpio_role_names =
    enum_names<GpioRole>({{GpioRole::emergency_stop, "emergency_stop"},
                          {GpioRole::part_in_position, "part_in_position"},
                          {GpioRole::enable, "enable"},
                          {GpioRole::ready_lamp, "ready_lamp"},
                          {GpioRole::fault_lamp, "fault_lamp"}});
inline constexpr std::size_t gpio_role_count = gpio_role_names.size();
[[nodiscard]] constexpr std::string_view name_of(GpioRole role) noexcept {
  return gpio_role_names[role];
}
[[nodiscard]] constexpr bool is_input(GpioRole role) noexcept {
  return role == GpioRole::emergency_stop || role == GpioRole::part_in_position;
}

/// The setting of the pull resistor inside the GPIO chip.
enum class GpioBias : std::uint8_t { as_is, disabled, pull_up, pull_down };
/// Names of the settings in rig files.
inline constexpr auto gpio_bias_names = enum_names<GpioBias>({{GpioBias::as_is, "as_is"},
                                                              {GpioBias::disabled, "disabled"},
                                                              {GpioBias::pull_up, "pull_up"},
                                                              {GpioBias::pull_down, "pull_down"}});

struct GpioLineSettings {
  GpioRole role = GpioRole::emergency_stop;
  std::string chip;                     ///< a word of exactly one chip that chips_in() returns
  std::string line;                     ///< name of the line; if the name is empty, `offset` selects the line
  std::optional<std::uint32_t> offset;  ///< number of the line in its chip; the first line has the number 0
  bool active_low = false;              ///< true: a low level means active (pressed, in position, on)
  GpioBias bias = GpioBias::as_is;      ///< setting of the pull resistor; used for inputs only
};
/// Returns a description of a line, for example "gpiochip0 line `ESTOP`, active high".
[[nodiscard]] std::string text_of(const GpioLineSettings& line);

/// A change of an input between its logical levels (active, inactive).
struct GpioEdge {
  GpioRole role = GpioRole::emergency_stop;
  bool active = false;
  Nanoseconds at = 0;  ///< time of the interrupt on MonotonicClock, measured by the kernel
};

/// The digital lines of a rig, after a successful request. Reading and writing do not allocate memory. All
/// functions except write() must be called from one thread. write() may also be called from a second thread
/// or a signal handler.
class GpioLines {
 public:
  GpioLines() = default;
  GpioLines(const GpioLines&) = delete;
  GpioLines& operator=(const GpioLines&) = delete;
  GpioLines(GpioLines&&) = delete;
  GpioLines& operator=(GpioLines&&) = delete;
  /// Releases the lines. After the release, the driver of the chip determines the level of an output.
  virtual ~GpioLines() = default;

  /// Waits at most `timeout` for edges and stores them at the start of `edges`. The edges of one line are in
  /// the order of time. Returns the number of edges, or nothing if the chip has failed. After a failure, all
  /// later calls fail too.
  [[nodiscard]] virtual std::optional<std::size_t> wait(Nanoseconds timeout,
                                                        std::span<GpioEdge> edges) noexcept = 0;
  /// Returns the present logical level of an input, or nothing if the chip has failed.
  [[nodiscard]] virtual std::optional<bool> read(GpioRole role) noexcept = 0;
  /// Sets the logical level of an output. Returns false if the chip has failed. If the rig has no line for
  /// `role`, the function has no effect and returns true.
  virtual bool write(GpioRole role, bool active) noexcept = 0;
  /// Returns true if all inputs of the rig report edges. A chip without interrupts reports only levels.
  [[nodiscard]] virtual bool sees_edges() const noexcept = 0;
};

/// The reason why the lines of a rig are not available.
struct GpioFailure {
  /// refused: the line does not exist, or its properties do not permit the settings in the rig file. failed:
  /// the operating system did not permit the request.
  enum class Kind : std::uint8_t { refused, failed };
  Kind kind = Kind::refused;
  std::size_t line = 0;  ///< index of the line in the list of settings
  std::string message;
  std::string hint;
};

/// Requests all lines through libgpiod, and sets the outputs to their inactive level. If one request fails,
/// all lines are released.
[[nodiscard]] tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines(
    std::span<const GpioLineSettings> lines);
/// Requests all lines as open_gpio_lines() does. The files of the chips are in the folder `devices`, and
/// sysfs is at `sys`.
[[nodiscard]] tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines_in(
    const std::filesystem::path& devices, const std::filesystem::path& sys,
    std::span<const GpioLineSettings> lines);

/// Returns the GPIO chips whose files are in the folder `devices`. The words of a chip are the names by which
/// a rig file can select it. These are its address in sysfs (`sys`), the names of links to its file, and its
/// label if this user may open the chip.
[[nodiscard]] std::vector<ComputerDevice> chips_in(const std::filesystem::path& devices = "/dev",
                                                   const std::filesystem::path& sys = "/sys");

}  // namespace softgrip::drivers
