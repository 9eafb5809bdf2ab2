#pragma once
// The GPIO chips of this computer.

#include <filesystem>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the chips whose files are in `devices`, each with its label, if it may be opened, and its address
/// in sysfs (`sys`). A link to the file of a chip is an additional word for that chip.
[[nodiscard]] std::vector<ComputerDevice> chips_in(const std::filesystem::path& devices = "/dev",
                                                   const std::filesystem::path& sys = "/sys");

}  // namespace softgrip::drivers
