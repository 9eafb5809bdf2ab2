#include "tools/command_line/command.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "document/problem.h"

namespace softgrip::tools {

std::string visible_lines(std::string_view text) {
  std::string lines;
  for (std::size_t begin = 0, end = 0; begin <= text.size(); begin = end + 1) {
    end = std::min(text.find('\n', begin), text.size());
    if (begin > 0) lines += '\n';
    lines += document::shown(text.substr(begin, end - begin), text.size());
  }
  return lines;
}

ExitCode fail(ExitCode code, std::string_view message) {
  std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, visible_lines(message).c_str());
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
