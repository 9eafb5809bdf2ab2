#pragma once
// Finds configuration files whose path the user did not give.

#include <filesystem>
#include <string>
#include <vector>

namespace softgrip::tools {

/// Returns the path of a file or folder of the configuration, for example "rig.yaml" or "boards". The path is
/// in ./config if it exists there, else in the installed configuration.
[[nodiscard]] std::string configuration_path(const std::string& name);
/// Returns the path of the folder with the installed configuration.
[[nodiscard]] std::string installed_configuration();
/// Returns the sorted names of the YAML files in a folder, without their extension. Returns an empty list if
/// the folder is unreadable.
[[nodiscard]] std::vector<std::string> document_names(const std::filesystem::path& folder);

}  // namespace softgrip::tools
