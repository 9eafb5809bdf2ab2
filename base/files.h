#pragma once
// Whole files, read with a bound and written so that nobody ever sees half of one.

#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip {

/// The bytes of a file of at most `bound` bytes, or a sentence that says why not.
[[nodiscard]] tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound);

/// Writes `path` through a temporary file beside it and a rename. Creates missing folders.
[[nodiscard]] tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents);

}  // namespace softgrip
