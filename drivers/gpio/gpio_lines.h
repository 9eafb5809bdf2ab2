#pragma once
// The digital lines of a rig: buttons, lamps, an enable output. The seam between what they mean
// (daemon/panel/panel.h) and the GPIO character device (drivers/gpio/gpio_libgpiod.cpp); tests put lines of
// their own here.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "model/reading.h"

namespace softgrip::drivers {

/// What a line is for; a rig has at most one of each.
enum class GpioRole : std::uint8_t { emergency_stop, part_in_position, enable, ready_lamp, fault_lamp };
inline constexpr std::size_t gpio_role_count = 5;
/// As the rig file names them: "emergency_stop" ...
[[nodiscard]] std::string_view name_of(GpioRole role) noexcept;
[[nodiscard]] constexpr bool is_input(GpioRole role) noexcept {
  return role == GpioRole::emergency_stop || role == GpioRole::part_in_position;
}

/// The resistor inside the chip.
enum class GpioBias : std::uint8_t { as_is, disabled, pull_up, pull_down };

struct GpioLineSettings {
  GpioRole role = GpioRole::emergency_stop;
  std::string chip;                     ///< a word that fits one of chips_in()
  std::string line;                     ///< the line's name; empty: `offset` counts
  std::optional<std::uint32_t> offset;  ///< of the line in its chip, from 0
  bool active_low = false;              ///< the low level means pressed, in position, on
  GpioBias bias = GpioBias::as_is;      ///< of inputs
};
/// "gpiochip0 line `ESTOP`, active high"
[[nodiscard]] std::string text_of(const GpioLineSettings& line);

/// A change of an input, in its logical sense.
struct GpioEdge {
  GpioRole role = GpioRole::emergency_stop;
  bool active = false;
  Nanoseconds at = 0;  ///< of MonotonicClock, taken by the kernel at the interrupt
};

/// Lines that were requested. Reading and writing allocate nothing. All calls but write() come from one
/// thread; write() may also come from a second thread or a signal handler.
class GpioLines {
 public:
  GpioLines() = default;
  GpioLines(const GpioLines&) = delete;
  GpioLines& operator=(const GpioLines&) = delete;
  GpioLines(GpioLines&&) = delete;
  GpioLines& operator=(GpioLines&&) = delete;
  /// Gives the lines back; what an output does then is its driver's own choice.
  virtual ~GpioLines() = default;

  /// Waits at most `timeout` for edges and fills `edges` from its front, in the order of their times per
  /// line. The number of them; nothing if the chip failed, which is then final.
  [[nodiscard]] virtual std::optional<std::size_t> wait(Nanoseconds timeout,
                                                        std::span<GpioEdge> edges) noexcept = 0;
  /// The present logical level of an input; nothing if the chip failed.
  [[nodiscard]] virtual std::optional<bool> read(GpioRole role) noexcept = 0;
  /// False if the chip failed. A role without a line is written by doing nothing.
  virtual bool write(GpioRole role, bool active) noexcept = 0;
  /// True if no input of the rig lacks edges: some chips have no interrupts, then levels are all there is.
  [[nodiscard]] virtual bool sees_edges() const noexcept = 0;
};

/// Why the lines of a rig cannot be had.
struct GpioFailure {
  /// refused: the rig file names what is not there, or not like that. failed: the system denied it.
  enum class Kind : std::uint8_t { refused, failed };
  Kind kind = Kind::refused;
  std::size_t line = 0;  ///< index into the settings
  std::string message;
  std::string hint;
};

/// Requests all lines through libgpiod, outputs inactive. Nothing is kept of them if one cannot be had.
[[nodiscard]] tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines(
    std::span<const GpioLineSettings> lines);
/// The same where the chips' files are in `devices` instead of /dev, and sysfs is at `sys`.
[[nodiscard]] tl::expected<std::unique_ptr<GpioLines>, GpioFailure> open_gpio_lines_in(
    const std::filesystem::path& devices, const std::filesystem::path& sys,
    std::span<const GpioLineSettings> lines);

}  // namespace softgrip::drivers
