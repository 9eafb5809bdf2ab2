#include "tools/client/set_option.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "document/node.h"

namespace softgrip::tools {
namespace {

tl::expected<control::Argument, std::string> argument_of(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == 0 || equals == std::string::npos) {
    return tl::unexpected("--set takes NAME=VALUE, as in --set squeeze_kpa=4, not '" + setting + "'");
  }
  document::Node value;
  value.kind = document::Node::Kind::scalar;
  value.scalar = setting.substr(equals + 1);
  const auto number = document::parse_number(value);
  const std::string name = setting.substr(0, equals);
  if (number.value) return control::Argument{name, *number.value};
  std::string message = "--set " + name + " " + number.message;
  if (!number.hint.empty()) message += ": " + number.hint;
  return tl::unexpected(std::move(message));
}

}  // namespace

void add_set_option(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--set", settings,
                  "Value of a parameter of the sequence, in place of the default value; may be given once "
                  "for each parameter")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

tl::expected<std::vector<control::Argument>, ExitCode> arguments_of(
    const std::vector<std::string>& settings) {
  std::vector<control::Argument> arguments;
  for (const std::string& setting : settings) {
    auto argument = argument_of(setting);
    if (!argument) return tl::unexpected(fail(ExitCode::usage, argument.error()));
    const auto same = [&](const control::Argument& other) { return other.name == argument->name; };
    if (std::any_of(arguments.begin(), arguments.end(), same)) {
      return tl::unexpected(fail(ExitCode::usage, "--set " + argument->name + " is given twice"));
    }
    arguments.push_back(std::move(*argument));
  }
  return arguments;
}

nlohmann::ordered_json json_of(const std::vector<control::Argument>& arguments) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const control::Argument& argument : arguments) json[argument.name] = argument.value;
  return json;
}

}  // namespace softgrip::tools
