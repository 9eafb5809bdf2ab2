#pragma once
// Prints messages for an invalid command line, with a suggestion.

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace softgrip::tools {

/// Prints help or version if the user requested it. Otherwise prints the error and the existing command or
/// option with the most similar name. Returns the exit code of the program: 0, 2, or the code of a
/// CLI::RuntimeError.
[[nodiscard]] int end_of(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv);

}  // namespace softgrip::tools
