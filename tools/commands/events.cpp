// softgrip events: prints the events of the daemon.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/clock.h"
#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/client/event_query.h"
#include "tools/command_line/options.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct EventsOptions {
  DaemonOptions daemon;
  std::string since;
  EventQuery query;
  bool follow = false;
};

void print(const Json& event, bool json) {
  if (json) {
    print_json(event);
    return;
  }
  std::printf("%6s  %s\n", std::to_string(event.value("id", std::uint64_t{0})).c_str(),
              line_of_event(event).c_str());
  std::fflush(stdout);
}

ExitCode run(const EventsOptions& chosen) {
  EventsOptions options = chosen;
  constexpr std::chrono::milliseconds pause{200};
  if (!options.since.empty()) {
    const auto since = parse_since(options.since, wall_time_now());
    if (!since) {
      return fail(ExitCode::usage,
                  "--since takes the number of an event or a time: 10min, 2h, 10:15, 2026-11-21 10:15");
    }
    options.query.since = *since;
  }
  auto client = DaemonClient::connect(options.daemon.socket);
  if (!client) return fail(client.error().code, client.error().message);
  while (true) {
    const auto found = query_events(*client, options.query);
    if (!found) return fail(found.error().code, found.error().message);
    if (found->missing > 0) {
      std::fprintf(stderr,
                   "softgrip: warning: %s events are missing, because the daemon no longer stores them\n",
                   std::to_string(found->missing).c_str());
    }
    for (const Json& event : found->events) print(event, options.daemon.json);
    if (!options.follow) return ExitCode::done;
    options.query.since.id = found->newest;
    // The option --lines limits the events of the past. Every new event is printed.
    options.query.lines = std::numeric_limits<std::size_t>::max();
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace

void add_events(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<EventsOptions>(
      program, outcome, "events", "Show the events of the daemon, newest last", run);
  add_daemon_options(*command, options->daemon);
  command
      ->add_option("-n,--lines,--limit", options->query.lines,
                   "Number of newest events to show; the daemon stores the last 10000 events")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  command->add_option(
      "--since", options->since,
      "Only events after the event with this number, or since a time: 10min, 2h, 10:15, 2026-11-21 10:15");
  command->add_option("--severity", options->query.severity, "Only events of at least this severity")
      ->capture_default_str()
      ->check(CLI::IsMember({"information", "warning", "error"}));
  command->add_flag("-f,--follow", options->follow,
                    "Also show new events as they occur, until the command is interrupted");
}

}  // namespace softgrip::tools
