#pragma once
// Opens serial devices with the settings of a serial line, and calculates the timing of this line.
// Checks that a path is the name of exactly one serial device of this computer.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/computer_device.h"
#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): the name in libmodbus

namespace softgrip::drivers {

/// The reason why a serial device could not be opened.
struct SerialFailure {
  const char* what = nullptr;  ///< action that failed; null: the device is open
  int error = 0;               ///< errno of the failed action; 0: the device accepted the settings without
                               ///< applying all of them
};

/// Creates a libmodbus context for the line. The caller must free the context. Returns null if libmodbus
/// refuses the device.
[[nodiscard]] _modbus* new_context(const SerialLine& line);

/// Locks, opens and configures the device with libmodbus, without blocking. The lock excludes other processes
/// while `master` is open. Without the lock, two Modbus clients on one line would read each other's responses
/// and change the settings. After the configuration, the function reads the settings of the device and
/// compares them with `line`. This check is needed, because libmodbus uses 9600 baud for an unknown rate, and
/// because tcsetattr() succeeds even if it could apply only some settings. The format of a pseudo-terminal is
/// not checked, because a pseudo-terminal has no wire. The function does not allocate memory.
[[nodiscard]] SerialFailure open_serial(_modbus* context, const SerialLine& line,
                                        Descriptor& master) noexcept;

/// Returns the duration of one character, including its start, parity and stop bits [s].
[[nodiscard]] double character_s(const SerialLine& line) noexcept;
/// Returns the silence before and after a frame [s]: the silence in the settings of the line if they give
/// one, otherwise the silence of the Modbus specification.
[[nodiscard]] double silence_s(const SerialLine& line) noexcept;
/// Sets parity and stop bits from the text "8N1", "8E1", "8O1", "8N2" or "8E2". Returns false for any other
/// text.
[[nodiscard]] bool set_format(std::string_view text, SerialLine& line) noexcept;
/// Returns the texts that set_format() accepts.
[[nodiscard]] std::span<const std::string_view> formats() noexcept;
/// Returns the settings of the line as text, for example "115200 8N1".
[[nodiscard]] std::string format_of(const SerialLine& line);

/// Time for which the driver of a USB adapter collects received bytes before it delivers them.
struct AdapterLatency {
  double seconds = 0;
  std::string path;  ///< file that contains the latency in milliseconds
};
/// Returns the adapter latency of a device. Returns nothing if the device is not connected now, or if its
/// driver has no latency setting. `sys` is the path of sysfs.
[[nodiscard]] std::optional<AdapterLatency> adapter_latency(const std::string& device,
                                                            const std::string& sys = "/sys");

/// Returns nothing if a path is the name of exactly one serial device, otherwise the reason why it is not.
/// There are two reasons. The path does not exist, or udev gave it to several devices, such as two adapters
/// of one type without a serial number. In the second case, the link in /dev leads to the device that was
/// connected last. Only names in /dev are checked. `root` is the folder that contains /dev and /run.
[[nodiscard]] std::optional<UnclearDevice> unclear_serial_device(const std::string& path,
                                                                 const std::filesystem::path& root = "/");

}  // namespace softgrip::drivers
