#include "tools/command_line/configuration.h"

#include <filesystem>

namespace softgrip::tools {

std::string configuration_path(const std::string& name) {
  std::string here = "config/" + name;
  return std::filesystem::exists(here) ? here : SOFTGRIP_CONFIG_DIR "/" + name;
}

}  // namespace softgrip::tools
