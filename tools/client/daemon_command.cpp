#include "tools/client/daemon_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace softgrip::tools {

using Json = nlohmann::ordered_json;

void add_daemon_options(CLI::App& command, DaemonOptions& options) {
  options.socket = default_socket_path();
  command.add_option("--socket", options.socket, "The daemon's socket; also $SOFTGRIP_SOCKET")
      ->capture_default_str();
  command.add_flag("--json", options.json, "Output as JSON");
}

tl::expected<Json, ExitCode> ask_daemon(const DaemonOptions& options, const Json& request) {
  auto client = DaemonClient::connect(options.socket);
  if (!client) return tl::unexpected{fail(client.error().code, client.error().message)};
  auto result = client->ask(request);
  if (!result) return tl::unexpected{fail(result.error().code, result.error().message)};
  return std::move(*result);
}

void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning, std::string done) {
  auto options = std::make_shared<DaemonOptions>();
  CLI::App* command = program.add_subcommand(name, meaning);
  add_daemon_options(*command, *options);
  command->callback([options, &outcome, name, done = std::move(done)] {
    const auto result = ask_daemon(*options, {{"command", name}});
    if (!result) {
      outcome = result.error();
    } else if (options->json) {
      print_json(*result);
    } else {
      std::printf("%s\n", done.c_str());
    }
  });
}

void print_json(const Json& json) {
  std::printf("%s\n", json.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
  std::fflush(stdout);
}

}  // namespace softgrip::tools
