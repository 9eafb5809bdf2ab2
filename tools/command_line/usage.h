#pragma once
// What is said of a command line that cannot be understood: with what was probably meant.

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace softgrip::tools {

/// Prints help or version where they were asked for, else what is wrong, with the nearest command or option
/// that there is. Returns what the process shall exit with: 0, 2, or the code that an option's callback left
/// by a CLI::RuntimeError.
[[nodiscard]] int end_of(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv);

}  // namespace softgrip::tools
