#include "tools/command_line/command.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "base/errno_text.h"
#include "base/files.h"
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

std::optional<ExitCode> unreadable(const std::string& path) {
  const auto cannot_read = [&](const std::string& reason) {
    return fail(ExitCode::io, "cannot read " + path + ": " + reason);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    if (::access(path.c_str(), R_OK) == 0) return std::nullopt;
    return cannot_read(text_of_errno(errno));
  }
  const auto file = open_regular(path);
  return file ? std::nullopt : std::optional(cannot_read(file.error()));
}

}  // namespace softgrip::tools
