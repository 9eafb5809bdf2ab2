#include "tools/commissioning/procedure.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace softgrip::tools::calibrate {

std::optional<double> typed_number(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return std::nullopt;
  const auto last = text.find_last_not_of(" \t\r");
  const char* const begin = text.data() + first + (text[first] == '+' ? 1 : 0);
  const char* const end = text.data() + last + 1;
  double value = 0;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc{} || result.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

TerminalOperator::TerminalOperator() : interactive_(::isatty(STDIN_FILENO) == 1) {}

void TerminalOperator::tell(const std::string& text) {
  std::fprintf(stderr, "  %s\n", text.c_str());
}

void TerminalOperator::ask(const std::string& question) {
  std::fprintf(stderr, "? %s: ", question.c_str());
  std::fflush(stderr);
}

std::optional<std::string> TerminalOperator::answer() {
  if (!prepared_.empty()) {
    std::string next = prepared_.front();
    prepared_.pop_front();
    std::fprintf(stderr, "%s\n", next.c_str());
    return next;
  }
  if (auto line = take_line()) return line;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (closed_ || ::poll(&input, 1, 0) <= 0) return std::nullopt;
  closed_ = pending_.receive(STDIN_FILENO, 256) != net::LineBuffer::Received::bytes;
  return take_line();
}

std::optional<std::string> TerminalOperator::take_line() {
  const auto next = pending_.next();
  if (!next) return std::nullopt;
  std::string line(*next);
  if (!interactive_) std::fprintf(stderr, "%s\n", line.c_str());
  return line;
}

}  // namespace softgrip::tools::calibrate
