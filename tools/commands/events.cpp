// softgrip events: what the daemon had to tell.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/client/daemon_command.h"
#include "tools/client/event_text.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  DaemonOptions daemon;
  std::uint64_t since = 0;
  std::uint64_t limit = 100;
  bool follow = false;
};

void print(const Json& event, bool json) {
  if (json) {
    print_json(event);
    return;
  }
  std::printf("%6s %s\n", std::to_string(event.value("id", std::uint64_t{0})).c_str(),
              line_of_event(event).c_str());
  std::fflush(stdout);
}

ExitCode run(const Options& options) {
  constexpr std::chrono::milliseconds pause{200};
  auto client = DaemonClient::connect(options.daemon.socket);
  if (!client) return fail(client.error().code, client.error().message);
  std::uint64_t since = options.since;
  while (true) {
    const auto result = client->ask({{"command", "events"}, {"since", since}, {"limit", options.limit}});
    if (!result) return fail(result.error().code, result.error().message);
    for (const Json& event : result->value("events", Json::array())) {
      print(event, options.daemon.json);
      since = event.value("id", since);
    }
    if (!options.follow) return ExitCode::done;
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace

void add_events(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("events", "What the daemon had to tell, oldest first");
  add_daemon_options(*command, options->daemon);
  command->add_option("--since", options->since, "Only events after the one with this number")
      ->capture_default_str();
  command->add_option("--limit", options->limit, "At most so many at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_flag("--follow", options->follow, "Go on with new ones until interrupted");
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
