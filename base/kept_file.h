#pragma once
// Files that people keep by hand and programs change.

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip {

/// Replaces a file that is there, with the old one's permissions,
/// through a temporary file beside it that has reached the disk before the rename. A symbolic link stays one.
/// Whatever fails (a full disk), the old file is what it was.
[[nodiscard]] tl::expected<void, std::string> replace_file(const std::string& path,
                                                           std::string_view contents);

/// Writes a file that is not there yet; one that is, is an error and stays.
[[nodiscard]] tl::expected<void, std::string> create_file(const std::string& path, std::string_view contents);

}  // namespace softgrip
