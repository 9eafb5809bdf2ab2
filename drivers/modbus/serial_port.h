#pragma once
// Serial devices: opening them with the settings of a line, and what their timing comes to.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/modbus/modbus_address.h"

namespace softgrip::drivers {

/// A device that was opened, or why not.
struct SerialPort {
  int descriptor = -1;
  const char* what = "";  ///< what failed
  int error = 0;          ///< errno; 0: the device took the settings but does not keep to them
};

/// Opens the device for this process alone, without blocking, with the line's settings, and reads them back.
/// A pseudo-terminal has no bits on a wire: it is not asked for parity. Allocates nothing.
[[nodiscard]] SerialPort open_serial(const SerialLine& line) noexcept;

/// Duration of one character with its start, parity and stop bits [s].
[[nodiscard]] double character_s(const SerialLine& line) noexcept;
/// Silence before and after a frame [s]: the line's own, or the specification's.
[[nodiscard]] double silence_s(const SerialLine& line) noexcept;
/// Sets parity and stop bits from "8N1", "8E1", "8O1", "8N2" or "8E2"; false for any other text.
[[nodiscard]] bool set_format(std::string_view text, SerialLine& line) noexcept;
/// The texts that set_format() takes.
[[nodiscard]] std::span<const std::string_view> formats() noexcept;
/// "115200 8N1"
[[nodiscard]] std::string format_of(const SerialLine& line);

/// How long the driver of an USB adapter may collect bytes before it hands them on.
struct AdapterLatency {
  double seconds = 0;
  std::string path;  ///< the file that holds it, in milliseconds
};
/// Of the device that is plugged in now; nothing if it is not there or knows no such thing. `sys` is where
/// sysfs is.
[[nodiscard]] std::optional<AdapterLatency> adapter_latency(const std::string& device,
                                                            const std::string& sys = "/sys");

}  // namespace softgrip::drivers
