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

std::optional<ExitCode> unreadable(const std::string& path) {
  const std::string why = why_unreadable(path);
  if (why.empty()) return std::nullopt;
  return fail(ExitCode::io, "cannot read " + path + ": " + why);
}

std::optional<ExitCode> refuse_folder(const std::string& path, const std::string& usual) {
  if (!is_folder(path)) return std::nullopt;
  const std::string inside = (std::filesystem::path(path) / usual).string();
  std::error_code error;
  const bool is_there = !usual.empty() && std::filesystem::exists(inside, error);
  return fail(ExitCode::io, "cannot read " + path + ": it is a folder, and this option requires a file" +
                                (is_there ? ". Give the file " + inside + " instead" : ""));
}

tl::expected<model::Model, ExitCode> read_model(const std::string& path) {
  return read_input(path, model::load_model, "model.yaml");
}

tl::expected<model::Model, ExitCode> read_rig_model(const std::string& path) {
  return read_input(path, model::load_rig_model, "model.yaml");
}

}  // namespace softgrip::tools
