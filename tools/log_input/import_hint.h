#pragma once
// Hint for a file that was refused as a log: the command that imports it.

#include <string>

namespace softgrip::tools {

/// Returns a sentence with the command line of `softgrip import` that converts the file, and a line break. If
/// the import needs more information, the command shows the columns, or selects one of several sheets.
/// Returns an empty text if the import would refuse the file too.
[[nodiscard]] std::string import_hint(const std::string& path);

}  // namespace softgrip::tools
