#include "tools/command_line/input_files.h"

#include <algorithm>
#include <system_error>

#include "base/files.h"
#include "model/file/model_file.h"

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

tl::expected<model::Model, ExitCode> read_model(const std::string& path) {
  return read_input(path, model::load_model);
}

tl::expected<model::Model, ExitCode> read_rig_model(const std::string& path) {
  return read_input(path, model::load_rig_model);
}

}  // namespace softgrip::tools
