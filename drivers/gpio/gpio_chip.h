#pragma once
// The GPIO chips of this computer.

#include <filesystem>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the chips whose files are in `devices`, each with its address in sysfs (`sys`) and, if the chip
/// may be opened, with its label. The name of a link to the file of a chip is an additional word for that
/// chip.
[[nodiscard]] std::vector<ComputerDevice> chips_in(const std::filesystem::path& devices = "/dev",
                                                   const std::filesystem::path& sys = "/sys");

}  // namespace softgrip::drivers
