#pragma once
// Which devices of this computer a rig file names: the udev rule of the package gives the service these and
// no others.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rig/rig_file.h"

namespace softgrip::daemon {

/// The parts of a device that the rig uses.
struct NamedDevice {
  std::vector<std::string> written;  ///< attributes of a converter that the daemon writes: out_voltage0_raw
};

/// Returns nothing for a device that the rig file does not name. `device`: the kernel's name, gpiochip0 or
/// iio:device0. `chips`: where the files of the GPIO chips are.
[[nodiscard]] std::optional<NamedDevice> named_device(const rig::RigFile& rig, const std::string& device,
                                                      const std::filesystem::path& chips = "/dev");

}  // namespace softgrip::daemon
