#include "tools/command.h"

#include <cstdio>

#include "model/document/problem.h"

namespace softgrip::tools {

ExitCode fail(ExitCode code, std::string_view message) {
  std::fprintf(stderr, "softgrip: %.*s\n", static_cast<int>(message.size()), message.data());
  return code;
}

ExitCode refuse(const document::Problems& problems) {
  std::fputs(problems.format().c_str(), stderr);
  std::fprintf(stderr, "%zu %s\n", problems.size(), problems.size() == 1 ? "error" : "errors");
  return ExitCode::input_refused;
}

}  // namespace softgrip::tools
