#pragma once
// The option `--set NAME=VALUE`, which sets a parameter of a sequence on the command line.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "control/tick/sequence.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

/// Adds the option --set to a command. The user may give the option several times.
void add_set_option(CLI::App& command, std::vector<std::string>& settings);

/// Parses the values of --set. If a value has no name or no number, prints a sentence to the standard error
/// and returns ExitCode::usage. Does not check names and ranges, because they are defined by the sequence.
[[nodiscard]] tl::expected<std::vector<control::Argument>, ExitCode> arguments_of(
    const std::vector<std::string>& settings);

/// Returns the parameters as JSON for the `start` command of the socket: {"squeeze_kpa": 4}.
[[nodiscard]] nlohmann::ordered_json json_of(const std::vector<control::Argument>& arguments);

}  // namespace softgrip::tools
