#include "tools/command_line/configuration.h"

#include <algorithm>
#include <system_error>

#include "base/files.h"

namespace softgrip::tools {

std::string configuration_path(const std::string& name) {
  std::string here = "config/" + name;
  return is_there(here) ? here : SOFTGRIP_CONFIG_DIR "/" + name;
}

std::string installed_configuration() {
  return SOFTGRIP_CONFIG_DIR;
}

std::vector<std::string> document_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() == ".yaml") names.push_back(entry->path().stem());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace softgrip::tools
