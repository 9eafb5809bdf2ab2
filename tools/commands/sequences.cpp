// softgrip sequences: lists the sequences that the daemon can start, with their parameters.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/command_line/options.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

struct SequencesOptions {
  DaemonOptions daemon;
  bool names = false;
};

ExitCode run(const SequencesOptions& options) {
  const auto result = call_daemon(options.daemon, {{"command", "sequences"}});
  if (!result) return result.error();
  if (options.daemon.json) {
    print_json(*result);
    return ExitCode::done;
  }
  const auto sequences = result->value("sequences", nlohmann::ordered_json::array());
  for (const std::string& line : options.names ? names_of_sequences(sequences) : view_of_sequences(sequences))
    std::printf("%s\n", line.c_str());
  if (sequences.empty()) std::fprintf(stderr, "the daemon's sequence directory contains no sequences\n");
  return ExitCode::done;
}

}  // namespace

void add_sequences(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<SequencesOptions>(
      program, outcome, "sequences", "List the sequences that the daemon can start, with their parameters",
      run);
  add_daemon_options(*command, options->daemon);
  command->add_flag("--names", options->names, "Print only the names");
}

}  // namespace softgrip::tools
