#pragma once
// `--set NAME=VALUE`: the parameters of a sequence on the command line.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "control/tick/parameter.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

/// Adds --set, which may come several times.
void add_set_option(CLI::App& command, std::vector<std::string>& settings);

/// What the user set. One that has no name or whose value is no number is refused with a sentence on the
/// standard error and ExitCode::usage; which names and values there may be only the sequence knows.
[[nodiscard]] tl::expected<std::vector<control::Argument>, ExitCode> arguments_of(
    const std::vector<std::string>& settings);

/// As the socket's `start` takes them: {"squeeze_kpa": 4}.
[[nodiscard]] nlohmann::ordered_json json_of(const std::vector<control::Argument>& arguments);

}  // namespace softgrip::tools
