#include "tools/command_line/progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace softgrip::tools {

ProgressLine::ProgressLine() : shown_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

std::function<void(const std::string&)> ProgressLine::show() const {
  if (!shown_) return {};
  return [](const std::string& text) {
    std::fprintf(stderr, "\r\033[K  %s ", text.c_str());
    std::fflush(stderr);
  };
}

}  // namespace softgrip::tools
