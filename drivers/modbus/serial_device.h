#pragma once
// Finds the serial device of this computer that a path names.

#include <filesystem>
#include <optional>
#include <string>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the reason why a path is not the name of one serial device: it does not exist, or udev gave it to
/// several devices (two adapters of one type without a serial number). In that case the link in /dev leads to
/// the device that was connected last. Only names in /dev are checked. `root` is the folder that contains
/// /dev and /run.
[[nodiscard]] std::optional<UnclearDevice> unclear_serial_device(const std::string& path,
                                                                 const std::filesystem::path& root = "/");

}  // namespace softgrip::drivers
