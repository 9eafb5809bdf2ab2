#pragma once
// The command that would make a log of a file that was refused as a log.

#include <string>

namespace softgrip::tools {

/// The command line of `softgrip import` that would, as a sentence that ends with a line break; where it
/// would have to be told more, the one that shows the columns, or takes one of several sheets; empty where
/// import would refuse the file, too.
[[nodiscard]] std::string import_hint(const std::string& path);

}  // namespace softgrip::tools
