#pragma once
// Reads an input file of a command with a function that collects the problems of the file.

#include <string>
#include <utility>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

/// Returns the result of read(path, problems). If the file cannot be opened or is refused, prints the reason
/// and returns the exit code.
template <class Read>
auto read_input(const std::string& path, Read read)
    -> tl::expected<typename decltype(read(path, std::declval<document::Problems&>()))::value_type,
                    ExitCode> {
  if (const auto code = unreadable(path)) return tl::unexpected(*code);
  document::Problems problems;
  auto result = read(path, problems);
  if (!result) return tl::unexpected(refuse(problems));
  return std::move(*result);
}

}  // namespace softgrip::tools
