#pragma once
// Provides the common code of subcommands: the creation of a subcommand, and options that several commands
// share.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/exit_code.h"
#include "base/option_checks.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

/// A subcommand and its options. The subcommand owns the options.
template <class Options>
struct Subcommand {
  CLI::App* command;
  Options* options;
};

/// Adds a subcommand to `program`. If the user chose this subcommand, run(options) is called after the
/// command line was parsed, and the result is stored in `outcome`.
template <class Options>
Subcommand<Options> add_command(CLI::App& program, ExitCode& outcome, const std::string& name,
                                const std::string& about, ExitCode (*run)(const Options&)) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand(name, about);
  command->callback([options, &outcome, run] { outcome = run(*options); });
  return {command, options.get()};
}

/// Adds a subcommand whose function `run` also gets the command's name and arguments (call_of()).
template <class Options>
Subcommand<Options> add_command(CLI::App& program, ExitCode& outcome, const std::string& name,
                                const std::string& about,
                                ExitCode (*run)(const Options&, const std::vector<std::string>& call)) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand(name, about);
  command->callback([options, command, &outcome, run] { outcome = run(*options, call_of(*command)); });
  return {command, options.get()};
}

/// Adds --seed and --threads to a command that uses random start points and resampling.
template <class Seed, class Threads>
void add_search_options(CLI::App& command, Seed& seed, Threads& threads) {
  command.add_option("--seed", seed, "Seed of the random start points and of the resampling")
      ->check(seed_number())
      ->capture_default_str();
  command.add_option("--threads", threads, "Number of threads; 0: one per core")->capture_default_str();
}

}  // namespace softgrip::tools
