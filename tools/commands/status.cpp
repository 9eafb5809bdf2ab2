// softgrip status: what the daemon does now.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/client/daemon_command.h"
#include "tools/client/status_view.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

ExitCode run(const DaemonOptions& options) {
  const auto status = ask_daemon(options, {{"command", "status"}});
  if (!status) return status.error();
  if (options.json) {
    print_json(*status);
    return ExitCode::done;
  }
  const ViewStyle style{on_terminal() ? terminal_columns() : 100, wants_colour(),
                        on_terminal() && has_unicode()};
  for (const std::string& line : view_of(*status, style)) std::printf("%s\n", line.c_str());
  return ExitCode::done;
}

}  // namespace

void add_status(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<DaemonOptions>();
  CLI::App* command = program.add_subcommand("status", "What the daemon does now");
  add_daemon_options(*command, *options);
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
