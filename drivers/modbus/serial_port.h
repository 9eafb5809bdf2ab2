#pragma once
// Opens serial devices with the settings of a line, and calculates their timing.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): the name in libmodbus

namespace softgrip::drivers {

/// The reason why a device was not opened.
struct SerialFailure {
  const char* what = nullptr;  ///< the step that failed; null: the device is open
  int error = 0;               ///< errno; 0: the device accepted the settings but does not apply them
};

/// Creates a libmodbus context for the line, which the caller must free; null if libmodbus refuses the
/// device.
[[nodiscard]] _modbus* new_context(const SerialLine& line);

/// Locks, opens and configures the device with libmodbus, without blocking. The lock excludes other processes
/// while `master` is open, because two Modbus clients on one line would read each other's responses and
/// change the settings. After the configuration, the function reads the settings back, because libmodbus uses
/// 9600 baud for an unknown rate, and tcsetattr() succeeds even if it could apply only some settings. The
/// format of a pseudo-terminal is not checked, because it has no wire. The function does not allocate.
[[nodiscard]] SerialFailure open_serial(_modbus* context, const SerialLine& line,
                                        Descriptor& master) noexcept;

/// Returns the duration of one character with its start, parity and stop bits [s].
[[nodiscard]] double character_s(const SerialLine& line) noexcept;
/// Returns the silence before and after a frame [s]: that of the line if it states one, else that of the
/// specification.
[[nodiscard]] double silence_s(const SerialLine& line) noexcept;
/// Sets parity and stop bits from "8N1", "8E1", "8O1", "8N2" or "8E2". Returns false for any other text.
[[nodiscard]] bool set_format(std::string_view text, SerialLine& line) noexcept;
/// Returns the texts that set_format() accepts.
[[nodiscard]] std::span<const std::string_view> formats() noexcept;
/// Returns, for example, "115200 8N1".
[[nodiscard]] std::string format_of(const SerialLine& line);

/// The time for which the driver of a USB adapter collects bytes before it delivers them.
struct AdapterLatency {
  double seconds = 0;
  std::string path;  ///< the file that contains the latency in milliseconds
};
/// Returns the latency of the device that is connected now; nothing if it is not connected or has no such
/// setting. `sys` is the path of sysfs.
[[nodiscard]] std::optional<AdapterLatency> adapter_latency(const std::string& device,
                                                            const std::string& sys = "/sys");

}  // namespace softgrip::drivers
