#pragma once
// Generates completion scripts for shells from the options and subcommands of the program.

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace softgrip::tools {

enum class Shell { bash, zsh, fish };
/// Parses "bash", "zsh" or "fish". Returns nullopt for any other name.
[[nodiscard]] std::optional<Shell> shell_named(std::string_view name);

/// Returns a script that completes the program's commands, options, allowed values and files. The script
/// requests the names of sequences from the daemon.
[[nodiscard]] std::string completion_script(const CLI::App& program, Shell shell);

}  // namespace softgrip::tools
