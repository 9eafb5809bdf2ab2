#pragma once
// Serial devices: opening them with the settings of a line, and what their timing comes to.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): so is libmodbus' modbus_t called

namespace softgrip::drivers {

/// Why a device did not open.
struct SerialFailure {
  const char* what = nullptr;  ///< what failed; none: the device is open
  int error = 0;               ///< errno; 0: the device took the settings but does not keep to them
};

/// A context of libmodbus for the line, to be freed; none if it takes no such device.
[[nodiscard]] _modbus* new_context(const SerialLine& line);

/// Lets libmodbus open the device without blocking and set it up. Before, the device is taken for this
/// process alone, for as long as `master` is open: two masters on one line would take each other's answers,
/// and the second would change the settings of the first. Behind, the settings are read back: libmodbus takes
/// a rate that it does not know for 9600, and tcsetattr succeeds if any of the settings was taken. A
/// pseudo-terminal has no bits on a wire: it is not asked for parity. Allocates nothing.
[[nodiscard]] SerialFailure open_serial(_modbus* context, const SerialLine& line,
                                        Descriptor& master) noexcept;

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
