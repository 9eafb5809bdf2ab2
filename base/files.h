#pragma once
// Files: regular ones, read with a bound, and written so that a reader never finds half of one.

#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip {

/// A regular file that is open for reading.
struct RegularFile {
  Descriptor descriptor;
  std::size_t size = 0;  ///< [bytes] when it was opened
};

/// Opens a regular file for reading, through links. It never waits for another process: a pipe, a device, a
/// socket, a folder and a file that another process has leased are errors. The error is the reason, without
/// the path. Use it for every file that another user or program can replace. The file system itself can still
/// block: a network mount whose server does not respond holds every call on it.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular(const std::string& path);

/// Opens the regular file `name` of an open folder as open_regular() does. A symbolic link is an error.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular_in(const Descriptor& folder,
                                                                     const std::string& name);

/// Returns the next `most` bytes of the file, or fewer where it ends. The error is the reason.
[[nodiscard]] tl::expected<std::string, std::string> read_start(const RegularFile& file, std::size_t most);

/// The bytes of a regular file of at most `bound` bytes, or a sentence that says why not.
[[nodiscard]] tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound);

/// Writes `path` through a temporary file beside it and a rename. Creates missing folders.
[[nodiscard]] tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents);

}  // namespace softgrip
