#pragma once
// How a command was called, so that it can be called again.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace softgrip::tools {

/// The command's name and what it was given, for its JSON: `softgrip report --verify` calls it so again. Not
/// where its output goes (--out, --json, --figures).
[[nodiscard]] std::vector<std::string> call_of(const CLI::App& command);

}  // namespace softgrip::tools
