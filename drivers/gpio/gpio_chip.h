#pragma once
// Which GPIO chip of this computer a rig file means.

#include <filesystem>
#include <string>

namespace softgrip::drivers {

/// True if the chip behind the file `device` (/dev/gpiochip0) has this name or this label.
[[nodiscard]] bool is_chip(const std::filesystem::path& device, const std::string& wanted);

}  // namespace softgrip::drivers
