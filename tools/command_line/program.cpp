#include "tools/command_line/program.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <set>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/version.h"
#include "document/problem.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/terminal.h"

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

/// Returns the shortest name that begins with `word`, otherwise the most similar name; "" if there is none.
std::string candidate_for(const std::string& word, const std::vector<std::string>& names) {
  // One or two letters begin several names, so they do not show which name is meant.
  constexpr std::size_t shortest_beginning = 3;
  const std::string* completed = nullptr;
  for (const std::string& name : names) {
    const bool begins = word.size() >= shortest_beginning && name.starts_with(word);
    if (begins && (completed == nullptr || name.size() < completed->size())) completed = &name;
  }
  return completed != nullptr ? *completed : document::nearest(word, names);
}

/// Suggests a command that moves a rig only if no other name is similar: a user may repeat the suggestion
/// without reading it.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  static const std::set<std::string> moving{"baseline", "calibrate", "investigate",
                                            "release",  "run",       "start"};
  std::vector<std::string> harmless;
  std::copy_if(names.begin(), names.end(), std::back_inserter(harmless),
               [](const std::string& name) { return !moving.contains(name); });
  std::string near = candidate_for(word, harmless);
  if (near.empty()) near = candidate_for(word, names);
  return near.empty() ? std::string() : "did you mean `" + near + "`?";
}

/// Returns the name of a command with the names of its parents: "softgrip study".
std::string name_of(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : name_of(*parent) + " " + command.get_name();
}

/// Returns the first word of the command line that should be a command but is unknown, or "".
std::string unknown_command(const CLI::App& program, int argc, char** argv) {
  const CLI::App& parent = innermost(program);
  if (command_names_of(parent).empty()) return {};
  bool after_parent = &parent == &program;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    if (after_parent && !word.starts_with('-')) return word;
    after_parent = after_parent || word == parent.get_name();
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
    const CLI::App& parent = innermost(program);
    const std::string hint = did_you_mean(word, command_names_of(parent));
    std::fprintf(stderr, "%s: there is no command `%s`%s%s\nRun with --help for more information.\n",
                 name_of(parent).c_str(), document::shown(word).c_str(), hint.empty() ? "" : "; ",
                 hint.c_str());
    return usage;
  }
  std::ostringstream message;
  const int code = program.exit(error, std::cout, message);
  std::fputs(visible_lines(message.str()).c_str(), stderr);
  if (code == 0) return 0;
  const CLI::App& command = innermost(program);
  for (const std::string& word : program.remaining(true)) {
    const std::string option = word.substr(0, word.find('='));
    if (!option.starts_with("--")) continue;
    const std::string hint = did_you_mean(option, options_of(command));
    if (!hint.empty()) std::fprintf(stderr, "%s: %s\n", document::shown(option).c_str(), hint.c_str());
  }
  return usage;
}

void refuse_options_as_values(CLI::App& program) {
  for (CLI::Option* const option : program.get_options()) {
    if (option->get_items_expected_max() == 0) continue;
    option->check(CLI::Validator(
        [](const std::string& word) {
          return word.starts_with("--")
                     ? "the value is missing, because " + document::shown(word) + " is the name of an option"
                     : std::string();
        },
        ""));
  }
  for (CLI::App* const command : program.get_subcommands({})) refuse_options_as_values(*command);
}

int run_server_program(const ServerProgram& program, int argc, char** argv) {
  try {
    CLI::App app{program.purpose, program.name};
    app.set_version_flag("--version", (program.name + " ").append(software_version()));
    program.add_options(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return end_of(app, error, argc, argv);
    }
    return static_cast<int>(program.run());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program.name.c_str(), error.what());
  }
  return static_cast<int>(ExitCode::failed);
}

void add_gateway_options(CLI::App& program, GatewayOptions& options, const std::string& file,
                         const std::string& config_help, const std::string& socket_help,
                         const std::function<void()>& add_others) {
  options.config = configuration_path(file);
  program.add_option("--config", options.config, config_help)->capture_default_str();
  program.add_option("--socket", options.socket, socket_help);
  program
      .add_option("--port", options.port, "TCP port; overrides the configuration file; 0 selects a free port")
      ->check(whole_between(0, 65535));
  add_others();
  program.add_flag("--check", options.check, "Check the configuration file, report its errors, and exit");
}

Descriptor take_server_signals(std::initializer_list<int> others) {
  std::vector<int> signals{SIGINT, SIGTERM, SIGHUP};
  signals.insert(signals.end(), others);
  std::signal(SIGPIPE, SIG_IGN);
  return take_signals(signals);
}

void say_ready(const std::string& message) {
  std::fputs(message.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace softgrip::tools
