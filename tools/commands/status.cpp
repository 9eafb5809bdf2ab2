// softgrip status: shows the state of the daemon.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "rig/rig_file.h"
#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/command_line/options.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

/// Returns the last health result of the rig that the daemon runs, or null if the rig file cannot be read.
nlohmann::ordered_json health_of(const nlohmann::ordered_json& status) {
  const auto file = status.find("rig_file");
  if (file == status.end() || !file->is_string()) return nullptr;
  const auto path = file->get<std::string>();
  if (::access(path.c_str(), R_OK) != 0) return nullptr;
  document::Problems problems;
  const auto rig = rig::load_rig(path, problems);
  return rig ? last_health(rig->recorder.directory) : nullptr;
}

ExitCode run(const DaemonOptions& options) {
  auto status = call_daemon(options, {{"command", "status"}});
  if (!status) return status.error();
  if (options.json) {
    const nlohmann::ordered_json health = health_of(*status);
    if (!health.is_null()) (*status)["health"] = health;
    print_json(*status);
    return ExitCode::done;
  }
  const ViewStyle style{on_terminal() ? terminal_columns() : 100, wants_colour(),
                        on_terminal() && has_unicode()};
  for (const std::string& line : view_of(*status, style)) std::printf("%s\n", line.c_str());
  // Print the status first, because reading the health result can block on a network mount that does not
  // respond.
  std::fflush(stdout);
  for (const HealthLine& line : health_lines(health_of(*status)))
    std::printf("health       %s\n", line.text.c_str());
  return ExitCode::done;
}

}  // namespace

void add_status(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] =
      add_command<DaemonOptions>(program, outcome, "status", "Show the state of the daemon", run);
  add_daemon_options(*command, *options);
}

}  // namespace softgrip::tools
