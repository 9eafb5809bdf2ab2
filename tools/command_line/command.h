#pragma once
// A subcommand of `softgrip` is one file under commands/ that defines
//
//   void add_NAME(CLI::App& program, ExitCode& outcome);
//
// and one line in commands.h. The function adds its subcommand to `program`. If the user chose this
// subcommand, the callback of the subcommand runs it and stores the exit code in `outcome`.
//
// The options and subcommands of the program also determine the completion scripts for shells.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exit_code.h"

namespace CLI {
class App;
}

namespace softgrip::document {
class Problems;
}

namespace softgrip::tools {

using AddCommand = void (*)(CLI::App& program, ExitCode& outcome);

/// Returns a text that a terminal can show: document::shown() replaces the control characters of each line,
/// and the line breaks stay.
[[nodiscard]] std::string visible_lines(std::string_view text);

/// Prints "PROGRAM: message" to the standard error and returns `code`, so that a command ends with `return
/// fail(ExitCode::io, ...)`. Prints the message as visible_lines().
ExitCode fail(ExitCode code, std::string_view message);

/// Prints all problems of the inputs to the standard error, each with its location, and then the number of
/// problems. Returns ExitCode::input_refused.
ExitCode refuse(const document::Problems& problems);

/// Returns the command's name and arguments for its JSON result, without the arguments that select the output
/// (--out, --json, --figures). `softgrip report --verify` repeats this call.
[[nodiscard]] std::vector<std::string> call_of(const CLI::App& command);

enum class Shell { bash, zsh, fish };
/// Parses "bash", "zsh" or "fish". Returns nullopt for any other name.
[[nodiscard]] std::optional<Shell> shell_named(std::string_view name);

/// Returns a script that completes the program's commands, options, allowed values and files. The script
/// requests the names of sequences from the daemon.
[[nodiscard]] std::string completion_script(const CLI::App& program, Shell shell);

}  // namespace softgrip::tools
