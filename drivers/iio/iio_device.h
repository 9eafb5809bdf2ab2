#pragma once
// The converters of this computer.

#include <filesystem>
#include <string>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the converters under `root` (/sys/bus/iio/devices), each with its attributes `label`, `name` and
/// `serialnumber`, its address on its bus and the serial number of its USB device. Missing words are omitted.
[[nodiscard]] std::vector<ComputerDevice> converters_in(const std::filesystem::path& root);

/// Returns the properties of a converter that remain when its node changes: its name and its place on its
/// bus. "mcp4725 at /sys/devices/platform/soc/fe804000.i2c/i2c-1/1-0060"; without a bus only the name.
[[nodiscard]] std::string identity_of(const ComputerDevice& converter);

/// Returns the kind of a channel: "voltage" for "voltage0".
[[nodiscard]] std::string type_of(const std::string& channel);
/// Returns the attribute that switches an output off: its own, or that of all outputs of its kind; an
/// empty text if the converter in `folder` has none.
[[nodiscard]] std::string powerdown_of(const std::filesystem::path& folder, const std::string& channel);

}  // namespace softgrip::drivers
