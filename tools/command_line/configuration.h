#pragma once
// Where configuration files are when the user does not say it.

#include <filesystem>
#include <string>
#include <vector>

namespace softgrip::tools {

/// The path of a file or folder of the configuration ("rig.yaml", "boards"): in ./config if it is there,
/// else where it is installed.
[[nodiscard]] std::string configuration_path(const std::string& name);
/// The folder where it is installed.
[[nodiscard]] std::string installed_configuration();
/// The YAML files of a folder without their ending, by name; none where it cannot be read.
[[nodiscard]] std::vector<std::string> document_names(const std::filesystem::path& folder);

}  // namespace softgrip::tools
