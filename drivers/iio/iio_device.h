#pragma once
// Which converter of this computer a rig file means.

#include <filesystem>
#include <string>

namespace softgrip::drivers {

/// Returns the name that a converter gives itself: its attribute `name`.
[[nodiscard]] std::string name_of_converter(const std::filesystem::path& folder);

/// True if a converter's folder (/sys/bus/iio/devices/iio:device0) is the device that a rig file names, by
/// its own name or by that of its folder.
[[nodiscard]] bool is_converter(const std::filesystem::path& folder, const std::string& device);

}  // namespace softgrip::drivers
