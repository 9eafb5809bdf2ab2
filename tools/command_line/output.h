#pragma once
// Writes the output files of commands and prepares their folders.

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"

namespace softgrip::tools {

/// Writes a file completely or not at all. "-" is the standard output. An existing path that is not a regular
/// file, for example a pipe, is opened and written, and so is a path that leads to an open descriptor of this
/// process, for example /dev/stdout. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<void, std::string> write_output(const std::string& path, std::string_view text);

/// Returns true for "-", for a path that leads to an open descriptor of this process, and for an existing
/// path that is not a regular file. The name of such an output does not define its format.
[[nodiscard]] bool is_stream(const std::string& path);

/// Returns ExitCode::usage and prints a sentence if one of `outputs` is the same file as one of `inputs`. Two
/// paths are the same file if device and inode are equal after links are resolved. An input that is the
/// folder of a recording represents its run.csv and run.json. Empty paths and "-" never match. If the folder
/// of an output is an existing file, returns ExitCode::usage if this file is an input, otherwise
/// ExitCode::io. Call this function before any computation.
[[nodiscard]] std::optional<ExitCode> refuse_overwriting(const std::vector<std::string>& outputs,
                                                         const std::vector<std::string>& inputs);

/// Returns the files that a command can replace in its output folder: files in the folder and its subfolders
/// whose names match one of the patterns. In a pattern, `*` represents any characters. If `folder` does not
/// exist or is a file, returns the paths that the patterns would have in `folder`. For the folder "", the
/// result is empty.
[[nodiscard]] std::vector<std::string> files_in(const std::string& folder,
                                                const std::vector<std::string>& patterns);

/// Creates the folder if it is missing. The error says why the folder is not writable. Call this function
/// before a long computation.
[[nodiscard]] tl::expected<void, std::string> prepare_folder(const std::string& folder);
/// Creates the parent folder of a file if it is missing. Returns no error for "-".
[[nodiscard]] tl::expected<void, std::string> prepare_parent(const std::string& path);

/// Returns the stream for the summary of a command that writes its output to `path`. This is the standard
/// output, or the standard error if `path` is the standard output.
[[nodiscard]] std::FILE* report_stream(const std::string& path);

}  // namespace softgrip::tools
