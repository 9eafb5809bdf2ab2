#include "base/standard_output.h"

#include <cerrno>
#include <cstdio>

#include "base/errno_text.h"

namespace softgrip {

ExitCode with_output_checked(ExitCode code, const char* program) noexcept {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  // stdout stores that an earlier write failed, but not the reason of the failure.
  const char* const reason =
      errno != 0 ? text_of_errno(errno) : "an earlier write failed, so a part of the output is lost";
  std::fprintf(stderr, "%s: cannot write to the standard output: %s\n", program, reason);
  return code == ExitCode::done ? ExitCode::io : code;
}

}  // namespace softgrip
