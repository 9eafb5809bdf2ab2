#pragma once
// Finds the GPIO chips of this computer.

#include <filesystem>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the GPIO chips whose files are in the folder `devices`. The words of a chip are the names by which
/// a rig file can select it. These are its address in sysfs (`sys`), the names of links to its file, and its
/// label if this user may open the chip.
[[nodiscard]] std::vector<ComputerDevice> chips_in(const std::filesystem::path& devices = "/dev",
                                                   const std::filesystem::path& sys = "/sys");

}  // namespace softgrip::drivers
