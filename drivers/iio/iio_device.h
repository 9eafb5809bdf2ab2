#pragma once
// Finds the A/D and D/A converters of this computer.

#include <filesystem>
#include <string>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the converters in the folder `root` (/sys/bus/iio/devices). The words of a converter are the names
/// by which a rig file can select it. These are its attributes `label`, `name` and `serialnumber`, its
/// address on its bus, and the serial number of its USB device, as far as they exist.
[[nodiscard]] std::vector<ComputerDevice> converters_in(const std::filesystem::path& root);

/// Returns the properties of a converter that stay the same when its name in the kernel changes: its `name`
/// and its position on its bus, for example "mcp4725 at /sys/devices/platform/soc/fe804000.i2c/i2c-1/1-0060".
/// If the converter has no bus address, returns only its `name`.
[[nodiscard]] std::string identity_of(const ComputerDevice& converter);

/// Returns the type of a channel, for example "voltage" for "voltage0".
[[nodiscard]] std::string type_of(const std::string& channel);
/// Returns the name of the attribute that switches off the output `channel`. The attribute belongs to this
/// output alone, or to all outputs of its type. Returns an empty text if the converter in `folder` has no
/// such attribute.
[[nodiscard]] std::string powerdown_of(const std::filesystem::path& folder, const std::string& channel);

}  // namespace softgrip::drivers
