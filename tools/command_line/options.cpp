#include "tools/command_line/options.h"

#include <CLI/CLI.hpp>

namespace softgrip::tools {

std::vector<std::string> call_of(const CLI::App& command) {
  std::vector<std::string> call{command.get_name()};
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || name == "--out" || name == "--json" || name == "--figures") continue;
    call.push_back(name);
    const bool is_flag = option->get_items_expected_max() == 0;
    if (!is_flag) call.insert(call.end(), option->results().begin(), option->results().end());
  }
  return call;
}

}  // namespace softgrip::tools
