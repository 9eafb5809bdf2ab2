#pragma once
// Where the output of a command goes.

#include <cstdio>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::tools {

/// Writes a file whole or not at all. "-" is the standard output, and what exists and is no regular file
/// (/dev/stdout, a pipe) is written to as it is. The error is one sentence.
[[nodiscard]] tl::expected<void, std::string> write_output(const std::string& path, std::string_view text);

/// True for "-" and for what exists and is no regular file: it has no name that could say what goes in.
[[nodiscard]] bool is_stream(const std::string& path);

/// Creates the folder if it is missing. The error says why nothing can be written into it: to be asked before
/// what takes minutes, not after.
[[nodiscard]] tl::expected<void, std::string> prepare_folder(const std::string& folder);
/// The same for the folder of a file; "-" is always writable.
[[nodiscard]] tl::expected<void, std::string> prepare_parent(const std::string& path);

/// Where to say what was done: the standard output, unless the output itself goes there.
[[nodiscard]] std::FILE* report_stream(const std::string& path);

}  // namespace softgrip::tools
