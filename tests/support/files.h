#pragma once
// Reads files in tests.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace softgrip::test {

/// Returns the whole content of a file, or "" if there is no file.
[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace softgrip::test
