#pragma once
// Returns a hint for a file that was refused as a log: the `softgrip import` command that converts the file.

#include <string>

namespace softgrip::tools {

/// Returns a sentence with the command line of `softgrip import` that converts the file, and a line break. If
/// the import needs more information, the command shows the columns of the file or selects one of its sheets.
/// Returns an empty text if the import would refuse the file as well.
[[nodiscard]] std::string import_hint(const std::string& path);

}  // namespace softgrip::tools
