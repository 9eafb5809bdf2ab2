// softgrip start: lets the daemon run a sequence.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/files.h"
#include "tools/client/daemon_command.h"
#include "tools/client/event_text.h"
#include "tools/client/set_option.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct StartOptions {
  DaemonOptions daemon;
  std::string sequence;
  std::vector<std::string> settings;
  bool wait = false;
};

/// The newest event of the daemon, so that only later ones are followed.
tl::expected<std::uint64_t, ClientFailure> newest_event(DaemonClient& client) {
  const auto result = client.ask({{"command", "events"}, {"since", 0}, {"limit", 1}});
  if (!result) return tl::unexpected{result.error()};
  return result->value("newest", std::uint64_t{0});
}

/// Prints what happens until the sequence that `request` started has ended.
ExitCode follow(DaemonClient& client, const StartOptions& options, std::uint64_t request,
                std::uint64_t since) {
  constexpr std::chrono::milliseconds pause{50};
  while (true) {
    const auto result = client.ask({{"command", "events"}, {"since", since}, {"limit", 1000}});
    if (!result) return fail(result.error().code, result.error().message);
    for (const Json& event : result->value("events", Json::array())) {
      since = event.value("id", since);
      if (options.daemon.json) {
        print_json(event);
      } else {
        std::printf("%s\n", line_of_event(event).c_str());
        std::fflush(stdout);
      }
      if (event.value("kind", "") == "sequence_finished" &&
          event.value("request", std::uint64_t{0}) == request) {
        return event.value("code", "") == "done" ? ExitCode::done : ExitCode::not_acceptable;
      }
    }
    std::this_thread::sleep_for(pause);
  }
}

ExitCode run(const StartOptions& options) {
  constexpr std::size_t longest_sequence = 256 * 1024;
  const auto arguments = arguments_of(options.settings);
  if (!arguments) return arguments.error();
  Json request{{"command", "start"}, {"sequence", options.sequence}};
  if (!arguments->empty()) request["parameters"] = json_of(*arguments);
  // A file here goes as a text; other names are the daemon's to find.
  if (::access(options.sequence.c_str(), R_OK) == 0) {
    const auto text = read_file(options.sequence, longest_sequence);
    if (!text) return fail(ExitCode::io, text.error());
    request["sequence_text"] = *text;
  }
  auto client = DaemonClient::connect(options.daemon.socket);
  if (!client) return fail(client.error().code, client.error().message);
  const auto newest = newest_event(*client);
  if (!newest) return fail(newest.error().code, newest.error().message);
  // Its motion may have to be planned first.
  constexpr std::chrono::seconds longest_planning{90};
  const auto accepted = client->ask(request, longest_planning);
  if (!accepted) return fail(accepted.error().code, accepted.error().message);
  if (const Json warnings = accepted->value("warnings", Json::array()); !warnings.empty())
    std::fprintf(stderr, "softgrip: warning:%s\n", listed(warnings).c_str());
  if (options.wait) return follow(*client, options, accepted->value("request", std::uint64_t{0}), *newest);
  if (options.daemon.json) {
    print_json(*accepted);
  } else {
    std::printf("started\n");
  }
  return ExitCode::done;
}

}  // namespace

void add_start(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<StartOptions>();
  CLI::App* command = program.add_subcommand("start", "Lets the daemon run a sequence");
  command->add_option("SEQUENCE", options->sequence, "A file, or a name in the daemon's sequence directory")
      ->required();
  add_set_option(*command, options->settings);
  add_daemon_options(*command, options->daemon);
  command->add_flag("--wait", options->wait, "Follow it to its end; exit code 6 unless every grip went well");
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
