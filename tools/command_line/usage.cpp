#include "tools/command_line/usage.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "base/exit_code.h"
#include "document/problem.h"

namespace softgrip::tools {
namespace {

/// Returns the last subcommand of the command line, or the program if the command line has no subcommand.
const CLI::App& innermost(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? program : innermost(*chosen.front());
}

std::vector<std::string> command_names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  const std::string near = document::nearest(word, names);
  return near.empty() ? std::string() : "did you mean `" + near + "`?";
}

/// Returns the first word of the command line that should be a command but is unknown, or "".
std::string unknown_command(const CLI::App& program, int argc, char** argv) {
  if (command_names_of(program).empty() || !program.get_subcommands().empty()) return {};
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    if (!word.starts_with('-')) return word;
  }
  return {};
}

}  // namespace

int end_of(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  const auto usage = static_cast<int>(ExitCode::usage);
  // A RuntimeError comes from a callback that has already printed its message.
  if (error.get_name() == "RuntimeError") return error.get_exit_code();
  if (const std::string word = unknown_command(program, argc, argv);
      !word.empty() && error.get_exit_code() != 0) {
    const std::string hint = did_you_mean(word, command_names_of(program));
    std::fprintf(stderr, "%s: there is no command `%s`%s%s\nRun with --help for more information.\n",
                 program.get_name().c_str(), document::shown(word).c_str(), hint.empty() ? "" : "; ",
                 hint.c_str());
    return usage;
  }
  if (program.exit(error) == 0) return 0;
  const CLI::App& command = innermost(program);
  for (const std::string& word : program.remaining(true)) {
    const std::string option = word.substr(0, word.find('='));
    if (!option.starts_with("--")) continue;
    const std::string hint = did_you_mean(option, options_of(command));
    if (!hint.empty()) std::fprintf(stderr, "%s: %s\n", document::shown(option).c_str(), hint.c_str());
  }
  return usage;
}

}  // namespace softgrip::tools
