#include "tools/client/daemon_command.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/json.h"
#include "document/problem.h"
#include "rig/rig_file.h"
#include "tools/command_line/input_files.h"

namespace softgrip::tools {

using Json = nlohmann::ordered_json;

namespace {

std::string socket_of(const std::string& rig) {
  document::Problems problems;
  if (const auto code = unreadable(rig)) throw CLI::RuntimeError(static_cast<int>(*code));
  const auto path = rig::socket_path_of(rig, problems);
  if (!path) throw CLI::RuntimeError(static_cast<int>(refuse(problems)));
  return *path;
}

}  // namespace

void add_daemon_options(CLI::App& command, DaemonOptions& options) {
  options.socket = default_socket_path();
  auto* socket =
      command.add_option("--socket", options.socket, "Socket of the daemon; also $SOFTGRIP_SOCKET")
          ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--rig", [&options](const std::string& path) { options.socket = socket_of(path); },
          "Rig file of the daemon; the path of the socket is read from this file")
      ->excludes(socket);
  command.add_flag("--json", options.json, "Print the result as JSON");
}

tl::expected<Json, ExitCode> call_daemon(const DaemonOptions& options, const Json& request) {
  auto client = DaemonClient::connect(options.socket);
  if (!client) return tl::unexpected{fail(client.error().code, client.error().message)};
  auto result = client->call(request);
  if (!result) return tl::unexpected{fail(result.error().code, result.error().message)};
  return std::move(*result);
}

void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning, std::function<std::string(const Json&)> done) {
  auto options = std::make_shared<DaemonOptions>();
  CLI::App* command = program.add_subcommand(name, meaning);
  add_daemon_options(*command, *options);
  command->callback([options, &outcome, name, done = std::move(done)] {
    const auto result = call_daemon(*options, {{"command", name}});
    if (!result) {
      outcome = result.error();
    } else if (options->json) {
      print_json(*result);
    } else {
      std::printf("%s\n", done(*result).c_str());
    }
  });
}

void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning, std::string done) {
  add_plain_request(program, outcome, name, meaning, [done = std::move(done)](const Json&) { return done; });
}

namespace {

/// Waits at most 3 s until the rig is idle or faulted, and returns `under_pressure` of the rig's status.
/// Returns null if no finger is pressurised, or if the rig still moves after 3 s.
Json pressurised_fingers(DaemonClient& client) {
  constexpr std::chrono::milliseconds pause{20};
  for (int looks = 0; looks < 150; ++looks) {
    const auto status = client.call({{"command", "status"}});
    if (!status) return nullptr;
    const std::string state = status->value("state", "");
    if (state == "idle" || state == "faulted") return status->value("under_pressure", Json());
    std::this_thread::sleep_for(pause);
  }
  return nullptr;
}

ExitCode end_motion(const DaemonOptions& options, const std::string& name, const std::string& done) {
  auto client = DaemonClient::connect(options.socket);
  if (!client) return fail(client.error().code, client.error().message);
  auto result = client->call({{"command", name}});
  if (!result) return fail(result.error().code, result.error().message);
  if (!options.json) {
    std::printf("%s\n", done.c_str());
    std::fflush(stdout);
  }
  Json pressurised = pressurised_fingers(*client);
  if (options.json) {
    (*result)["under_pressure"] = std::move(pressurised);
    print_json(*result);
  } else if (pressurised.is_object()) {
    std::printf("%s\n", document::shown(pressurised.value("text", ""), 1000).c_str());
  }
  return ExitCode::done;
}

}  // namespace

void add_ending_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                        const std::string& meaning, std::string done) {
  auto options = std::make_shared<DaemonOptions>();
  CLI::App* command = program.add_subcommand(name, meaning);
  add_daemon_options(*command, *options);
  command->callback(
      [options, &outcome, name, done = std::move(done)] { outcome = end_motion(*options, name, done); });
}

void print_json(const Json& json) {
  std::printf("%s\n", json_dump(json).c_str());
  std::fflush(stdout);
}

}  // namespace softgrip::tools
