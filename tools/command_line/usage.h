#pragma once
// Prints messages for an invalid command line, with a suggestion.

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace softgrip::tools {

/// Prints help or version if requested. Otherwise prints the error with the nearest existing command or
/// option. Returns the exit code of the program: 0, 2, or the code that an option's callback passed with a
/// CLI::RuntimeError.
[[nodiscard]] int end_of(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv);

}  // namespace softgrip::tools
