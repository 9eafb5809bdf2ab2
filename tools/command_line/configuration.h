#pragma once
// Where configuration files are when the user does not say it.

#include <string>

namespace softgrip::tools {

/// The path of a file of the configuration ("rig.yaml", "boards/adam-6024.yaml"): in ./config if it is there,
/// else where it is installed.
[[nodiscard]] std::string configuration_path(const std::string& name);

}  // namespace softgrip::tools
