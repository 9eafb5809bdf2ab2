#pragma once
// Finds the devices of this computer that a rig file names. The udev rule of the package gives the service
// access to these devices and to no others.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rig/rig_file.h"

namespace softgrip::daemon {

/// The parts of a device that the rig uses.
struct NamedDevice {
  std::vector<std::string> written;  ///< attributes of the converter that the daemon writes, such as
                                     ///< out_voltage0_raw
};

/// Returns the parts of `device` that the rig uses. Returns nothing if the rig file does not name this
/// device. `device` is the name in the kernel, such as gpiochip0 or iio:device0. `chips` is the folder that
/// contains the device files of the GPIO chips.
[[nodiscard]] std::optional<NamedDevice> named_device(const rig::RigFile& rig, const std::string& device,
                                                      const std::filesystem::path& chips = "/dev");

}  // namespace softgrip::daemon
