#pragma once
// Records how a command was called, so that the call can be repeated.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace softgrip::tools {

/// Returns the command's name and arguments for its JSON result, without the arguments that select the output
/// (--out, --json, --figures). `softgrip report --verify` repeats this call.
[[nodiscard]] std::vector<std::string> call_of(const CLI::App& command);

}  // namespace softgrip::tools
