#pragma once
// Checks that a path is the name of exactly one serial device of this computer.

#include <filesystem>
#include <optional>
#include <string>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns nothing if a path is the name of exactly one serial device, otherwise the reason why it is not.
/// There are two reasons. The path does not exist, or udev gave it to several devices, such as two adapters
/// of one type without a serial number. In the second case, the link in /dev leads to the device that was
/// connected last. Only names in /dev are checked. `root` is the folder that contains /dev and /run.
[[nodiscard]] std::optional<UnclearDevice> unclear_serial_device(const std::string& path,
                                                                 const std::filesystem::path& root = "/");

}  // namespace softgrip::drivers
