// softgrip-web: serves softgripd's data to browsers and Prometheus over HTTP.

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "base/files.h"
#include "base/net/listener.h"
#include "base/version.h"
#include "tools/command_line/command.h"
#include "tools/command_line/configuration.h"
#include "tools/command_line/terminal.h"
#include "tools/command_line/usage.h"
#include "tools/web/places.h"
#include "tools/web/server.h"

namespace softgrip::web {
namespace {

/// Path of the file that the package libjs-chart.js installs.
constexpr const char* chart_path = "/usr/share/javascript/chart.js/chart.min.js";
constexpr std::size_t largest_chart = std::size_t{4} << 20U;

struct Options {
  std::string config;
  std::string socket;
  std::optional<std::uint16_t> port;
  std::string recordings;
  bool operate = false;
  bool check = false;
};

void add_options(CLI::App& program, Options& options) {
  options.config = tools::configuration_path("web.yaml");
  program.set_version_flag("--version", std::string{"softgrip-web "}.append(software_version()));
  program.add_option("--config", options.config, "Configuration file")->capture_default_str();
  program.add_option("--socket", options.socket,
                     "Socket of the daemon; overrides both sockets of the configuration file");
  program.add_option("--port", options.port,
                     "TCP port; overrides the configuration file; 0 selects a free port");
  program.add_option("--recordings", options.recordings,
                     "Folder of recordings; overrides the configuration file");
  program.add_flag("--operate", options.operate,
                   "Allow every client to move the gripper; permitted only on loopback addresses");
  program.add_flag("--check", options.check, "Check the configuration file, report its errors, and exit");
  program.footer("The server is ready when it has printed 'listening on http://ADDRESS:PORT/'.");
}

/// Replaces settings of the file by the settings that the command line gives.
void put_in_place(const Options& options, Settings& settings) {
  if (!options.socket.empty()) settings.look_socket = settings.operate_socket = options.socket;
  if (options.port) settings.port = *options.port;
  if (!options.recordings.empty()) settings.recordings = options.recordings;
  if (options.operate) settings.without_token = Role::operate;
}

ExitCode run(const Options& options) {
  if (const auto code = tools::unreadable(options.config)) return *code;
  document::Problems problems;
  auto settings = load_settings(options.config, problems);
  if (!settings) return tools::refuse(problems);
  put_in_place(options, *settings);
  if (options.operate && !net::is_loopback(settings->address))
    return tools::fail(
        ExitCode::usage,
        "--operate is permitted only on loopback addresses; on other addresses, clients need a token");
  Tokens tokens;
  if (!settings->tokens.empty()) {
    auto loaded = Tokens::load(settings->tokens);
    if (!loaded) return tools::fail(ExitCode::input_refused, loaded.error());
    tokens = std::move(*loaded);
  }
  if (options.check) return ExitCode::done;
  if (const std::size_t places = places_for(settings->max_connections, descriptor_limit());
      places < settings->max_connections) {
    std::fprintf(stderr,
                 "softgrip-web: the limit of open files allows %zu connections, not %zu (max_connections)\n",
                 places, settings->max_connections);
  }
  Descriptor signals = tools::take_signals({SIGINT, SIGTERM, SIGHUP});
  std::signal(SIGPIPE, SIG_IGN);
  auto listener = net::listen_tcp(settings->address, settings->port);
  if (!listener) return tools::fail(ExitCode::io, listener.error());
  const bool six = settings->address.find(':') != std::string::npos;
  std::printf("listening on http://%s%s%s:%u/\n", six ? "[" : "", settings->address.c_str(), six ? "]" : "",
              unsigned{listener->port});
  std::fflush(stdout);
  // Without this file, the page shows no curves and names the missing package.
  auto chart = read_file(chart_path, largest_chart);
  Server(*settings, std::move(tokens), chart ? std::move(*chart) : std::string(), std::move(listener->socket),
         std::move(signals))
      .run();
  return ExitCode::done;
}

}  // namespace
}  // namespace softgrip::web

int main(int argc, char** argv) {
  using namespace softgrip;
  try {
    CLI::App program{"HTTP server that connects browsers and Prometheus to the socket of softgripd.",
                     "softgrip-web"};
    web::Options options;
    web::add_options(program, options);
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return tools::end_of(program, error, argc, argv);
    }
    return static_cast<int>(web::run(options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "softgrip-web: %s\n", error.what());
  }
  return static_cast<int>(ExitCode::failed);
}
