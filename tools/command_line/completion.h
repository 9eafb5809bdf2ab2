#pragma once
// Completion for shells, out of the options and subcommands that the program has: it cannot know others.

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace softgrip::tools {

enum class Shell { bash, zsh, fish };
/// "bash", "zsh", "fish"; nothing for another name.
[[nodiscard]] std::optional<Shell> shell_named(std::string_view name);

/// A script that completes the program's commands, options, the words that an option takes, and files. A
/// sequence that a daemon starts is completed with the names that the daemon says.
[[nodiscard]] std::string completion_script(const CLI::App& program, Shell shell);

}  // namespace softgrip::tools
