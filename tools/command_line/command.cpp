#include "tools/command_line/command.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "base/files.h"
#include "base/text.h"
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

std::string why_unreadable(const std::string& path) {
  if (is_folder(path)) return ::access(path.c_str(), R_OK) == 0 ? std::string() : text_of_errno(errno);
  const auto file = open_regular(path);
  return file ? std::string() : file.error();
}

std::optional<ExitCode> unreadable(const std::string& path) {
  const std::string why = why_unreadable(path);
  if (why.empty()) return std::nullopt;
  return fail(ExitCode::io, "cannot read " + path + ": " + why);
}

}  // namespace softgrip::tools
