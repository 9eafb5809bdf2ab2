#pragma once
// Finds the devices of this computer that a rig file names. The package's udev rule gives the service only
// these devices.

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

/// Returns the parts of `device` that the rig uses, or nothing if the rig file does not name this device.
/// `device`: name in the kernel, gpiochip0 or iio:device0. `chips`: folder of the GPIO chips' files.
[[nodiscard]] std::optional<NamedDevice> named_device(const rig::RigFile& rig, const std::string& device,
                                                      const std::filesystem::path& chips = "/dev");

}  // namespace softgrip::daemon
