#pragma once
// Which serial device of this computer a path means.

#include <filesystem>
#include <optional>
#include <string>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns why a path is not the name of one serial device: it is not there, or udev gave it to several
/// devices (two adapters of one type without a serial number), of which the link in /dev follows the one that
/// came last. Only names in /dev are judged. `root`: the folder in which /dev and /run are.
[[nodiscard]] std::optional<UnclearDevice> unclear_serial_device(const std::string& path,
                                                                 const std::filesystem::path& root = "/");

}  // namespace softgrip::drivers
