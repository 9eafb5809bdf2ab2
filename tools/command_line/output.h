#pragma once
// Writes the output of commands.

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"

namespace softgrip::tools {

/// Writes a file completely or not at all. "-" is the standard output. An existing path that is not a regular
/// file (/dev/stdout, a pipe) is opened and written. The error is one sentence.
[[nodiscard]] tl::expected<void, std::string> write_output(const std::string& path, std::string_view text);

/// Returns true for "-" and for an existing path that is not a regular file. The name of such an output does
/// not define its format.
[[nodiscard]] bool is_stream(const std::string& path);

/// Returns ExitCode::usage and prints a sentence if one of `outputs` is the same file as one of `inputs`.
/// Files are the same if device and inode are equal after links are resolved. An input may be a recording's
/// folder, which stands for its run.csv and run.json. Empty paths and "-" never match. Call this before any
/// computation.
[[nodiscard]] std::optional<ExitCode> refuse_overwriting(const std::vector<std::string>& outputs,
                                                         const std::vector<std::string>& inputs);

/// Returns the files that a command can replace in its output folder: files in the folder and in its
/// subfolders whose names match one of the patterns (`*`: any characters). For "", the result is empty.
[[nodiscard]] std::vector<std::string> files_in(const std::string& folder,
                                                const std::vector<std::string>& patterns);

/// Creates the folder if it is missing. The error says why the folder is not writable. Call this before a
/// long computation.
[[nodiscard]] tl::expected<void, std::string> prepare_folder(const std::string& folder);
/// Creates the parent folder of a file if it is missing. "-" is always writable.
[[nodiscard]] tl::expected<void, std::string> prepare_parent(const std::string& path);

/// Returns the stream for the summary of a command that writes its output to `path`: the standard output, or
/// the standard error if the output itself is written to the standard output.
[[nodiscard]] std::FILE* report_stream(const std::string& path);

}  // namespace softgrip::tools
