#pragma once
// Finds configuration files without an explicit path.

#include <filesystem>
#include <string>
#include <vector>

namespace softgrip::tools {

/// Returns the path of a file or folder of the configuration ("rig.yaml", "boards"): in ./config if it exists
/// there, else in the installed configuration.
[[nodiscard]] std::string configuration_path(const std::string& name);
/// Returns the folder of the installed configuration.
[[nodiscard]] std::string installed_configuration();
/// Returns the sorted names of the YAML files in a folder, without their extension. The list is empty if the
/// folder is unreadable.
[[nodiscard]] std::vector<std::string> document_names(const std::filesystem::path& folder);

}  // namespace softgrip::tools
