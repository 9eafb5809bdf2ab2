// softgrip-web: provides softgripd's data to browsers and Prometheus over HTTP.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/files.h"
#include "base/net/listener.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/program.h"
#include "tools/web/connection_limits.h"
#include "tools/web/server.h"

namespace softgrip::web {
namespace {

/// Path of the file that the package libjs-chart.js installs.
constexpr const char* chart_path = "/usr/share/javascript/chart.js/chart.min.js";
constexpr std::size_t largest_chart = std::size_t{4} << 20U;

struct Options : tools::GatewayOptions {
  std::string recordings;
  bool operate = false;
};

void add_options(CLI::App& program, Options& options) {
  tools::add_gateway_options(
      program, options, "web.yaml", "Configuration file",
      "Socket of the daemon; overrides both sockets of the configuration file", [&] {
        program.add_option("--recordings", options.recordings,
                           "Folder of recordings; overrides the configuration file");
        program.add_flag("--operate", options.operate,
                         "Allow every client to move the gripper; permitted only on loopback addresses");
      });
  program.footer("The server is ready when it has printed 'listening on http://ADDRESS:PORT/'.");
}

/// Replaces settings of the file by the settings on the command line.
void put_in_place(const Options& options, Settings& settings) {
  if (!options.socket.empty()) settings.look_socket = settings.operate_socket = options.socket;
  if (options.port) settings.port = *options.port;
  if (!options.recordings.empty()) settings.recordings = options.recordings;
  if (options.operate) settings.without_token = Role::operate;
}

ExitCode run(const Options& options) {
  auto settings = tools::read_input(options.config, load_settings);
  if (!settings) return settings.error();
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
  if (options.check) {
    std::printf("%s: ok\n", options.config.c_str());
    return ExitCode::done;
  }
  if (const std::size_t available = max_connections_for(settings->max_connections, descriptor_limit());
      available < settings->max_connections) {
    std::fprintf(stderr,
                 "softgrip-web: the limit of open files allows %zu connections, not %zu (max_connections)\n",
                 available, settings->max_connections);
  }
  Descriptor signals = tools::take_server_signals();
  auto listener = net::listen_tcp(settings->address, settings->port);
  if (!listener) return tools::fail(ExitCode::io, listener.error());
  const bool six = settings->address.find(':') != std::string::npos;
  tools::say_ready(fmt::format("listening on http://{}{}{}:{}/\n", six ? "[" : "", settings->address,
                               six ? "]" : "", listener->port));
  // If this file does not exist, the page shows no curves and names the missing package.
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
  web::Options options;
  return tools::run_server_program(
      {"softgrip-web", "HTTP server that connects browsers and Prometheus to the socket of softgripd.",
       [&](CLI::App& program) { web::add_options(program, options); }, [&] { return web::run(options); }},
      argc, argv);
}
