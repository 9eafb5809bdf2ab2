#pragma once
// Finds the GPIO chips of this computer.

#include <filesystem>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the chips whose files are in the folder `devices`. Each chip has its address in sysfs (`sys`) as a
/// word, and also its label if this user may open the chip. If a link leads to the file of a chip, the name
/// of the link is a further word of the chip.
[[nodiscard]] std::vector<ComputerDevice> chips_in(const std::filesystem::path& devices = "/dev",
                                                   const std::filesystem::path& sys = "/sys");

}  // namespace softgrip::drivers
