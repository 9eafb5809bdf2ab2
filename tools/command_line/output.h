#pragma once
// Where the output of a command goes.

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"

namespace softgrip::tools {

/// Writes a file whole or not at all. "-" is the standard output, and what exists and is no regular file
/// (/dev/stdout, a pipe) is written to as it is. The error is one sentence.
[[nodiscard]] tl::expected<void, std::string> write_output(const std::string& path, std::string_view text);

/// True for "-" and for what exists and is no regular file: it has no name that could say what goes in.
[[nodiscard]] bool is_stream(const std::string& path);

/// Returns ExitCode::usage, and prints a sentence, if one of `outputs` is the same file as one of `inputs`:
/// same device and inode, through links. An input may be a recording's folder: its run.csv and run.json
/// count. Empty paths and "-" never match. Ask before anything is computed.
[[nodiscard]] std::optional<ExitCode> refuse_overwriting(const std::vector<std::string>& outputs,
                                                         const std::vector<std::string>& inputs);

/// The same for a command that fills a folder: returns the files in it, and in the folders in it, whose names
/// match one of the patterns (`*`: any characters), which the command can replace. "" has none.
[[nodiscard]] std::vector<std::string> files_in(const std::string& folder,
                                                const std::vector<std::string>& patterns);

/// Creates the folder if it is missing. The error says why nothing can be written into it: to be asked before
/// what takes minutes, not after.
[[nodiscard]] tl::expected<void, std::string> prepare_folder(const std::string& folder);
/// The same for the folder of a file; "-" is always writable.
[[nodiscard]] tl::expected<void, std::string> prepare_parent(const std::string& path);

/// Where to say what was done: the standard output, unless the output itself goes there.
[[nodiscard]] std::FILE* report_stream(const std::string& path);

}  // namespace softgrip::tools
