// softgrip-plc: connects PLCs and robot controllers to softgripd over Modbus TCP.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "base/net/listener.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/program.h"
#include "tools/plc/server.h"

namespace softgrip::plc {
namespace {

void add_options(CLI::App& program, tools::GatewayOptions& options) {
  tools::add_gateway_options(
      program, options, "plc.yaml",
      "Configuration file: addresses, access, recipes, reaction to a stopped heartbeat, register map",
      "Socket of the daemon; overrides the configuration file");
  program.footer("The server is ready when it has printed 'listening on ADDRESS:PORT'.");
}

ExitCode run(const tools::GatewayOptions& options) {
  auto settings = tools::read_input(options.config, load_settings);
  if (!settings) return settings.error();
  if (!options.socket.empty()) settings->socket = options.socket;
  if (options.port) settings->port = *options.port;
  if (options.check) {
    std::printf("%s: ok\n", options.config.c_str());
    return ExitCode::done;
  }
  Descriptor signals = tools::take_server_signals();
  auto listener = net::listen_tcp(settings->address, settings->port);
  if (!listener) return tools::fail(ExitCode::io, listener.error());
  tools::say_ready(fmt::format("listening on {}:{}\n", settings->address, listener->port));
  Gateway gateway(*settings);
  Server(*settings, gateway, std::move(listener->socket), std::move(signals)).run();
  return ExitCode::done;
}

}  // namespace
}  // namespace softgrip::plc

int main(int argc, char** argv) {
  using namespace softgrip;
  tools::GatewayOptions options;
  return tools::run_server_program(
      {"softgrip-plc",
       "Modbus TCP server that connects PLCs and robot controllers to the socket of softgripd.",
       [&](CLI::App& program) { plc::add_options(program, options); }, [&] { return plc::run(options); }},
      argc, argv);
}
