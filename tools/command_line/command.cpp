#include "tools/command_line/command.h"

#include <cerrno>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "document/problem.h"

namespace softgrip::tools {

ExitCode fail(ExitCode code, std::string_view message) {
  std::fprintf(stderr, "%s: %.*s\n", program_invocation_short_name, static_cast<int>(message.size()),
               message.data());
  return code;
}

ExitCode refuse(const document::Problems& problems) {
  std::fputs(problems.format().c_str(), stderr);
  std::fprintf(stderr, "%zu %s\n", problems.size(), problems.size() == 1 ? "error" : "errors");
  return ExitCode::input_refused;
}

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
