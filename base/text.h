#pragma once
// Numbers as text for machine-read files: the fewest digits that read back to the same double.

#include <charconv>
#include <string>

namespace softgrip {

/// Shortest text that reads back to the same double; independent of the locale.
[[nodiscard]] inline std::string to_text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

}  // namespace softgrip
