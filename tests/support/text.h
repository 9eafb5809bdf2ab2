#pragma once
// Examines texts in tests.

#include <cstddef>
#include <string>

namespace softgrip::test {

/// Returns how many times `part` occurs in `text`.
[[nodiscard]] inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace softgrip::test
