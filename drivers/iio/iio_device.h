#pragma once
// The converters of this computer.

#include <filesystem>
#include <string>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the converters under `root` (/sys/bus/iio/devices). The words of a converter are its attributes
/// `label`, `name` and `serialnumber`, its address on its bus and the serial number of its USB device.
/// Missing words are omitted.
[[nodiscard]] std::vector<ComputerDevice> converters_in(const std::filesystem::path& root);

/// Returns the properties of a converter that remain when its node changes: its name and its place on its
/// bus, for example "mcp4725 at /sys/devices/platform/soc/fe804000.i2c/i2c-1/1-0060". For a converter without
/// a bus address, returns only the name.
[[nodiscard]] std::string identity_of(const ComputerDevice& converter);

/// Returns the kind of a channel: "voltage" for "voltage0".
[[nodiscard]] std::string type_of(const std::string& channel);
/// Returns the name of the attribute that switches an output off: that of this output, or that of all outputs
/// of the same kind. Returns an empty text if the converter in `folder` has neither.
[[nodiscard]] std::string powerdown_of(const std::filesystem::path& folder, const std::string& channel);

}  // namespace softgrip::drivers
