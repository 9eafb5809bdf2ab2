// softgrip-plc: connects PLCs and robot controllers to softgripd over Modbus TCP.

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "base/net/listener.h"
#include "base/version.h"
#include "tools/command_line/command.h"
#include "tools/command_line/configuration.h"
#include "tools/command_line/terminal.h"
#include "tools/command_line/usage.h"
#include "tools/plc/server.h"

namespace softgrip::plc {
namespace {

struct Options {
  std::string config;
  std::string socket;
  std::optional<std::uint16_t> port;
  bool check = false;
};

void add_options(CLI::App& program, Options& options) {
  options.config = tools::configuration_path("plc.yaml");
  program.set_version_flag("--version", std::string{"softgrip-plc "}.append(software_version()));
  program
      .add_option("--config", options.config, "Configuration file: addresses, access and the register map")
      ->capture_default_str();
  program.add_option("--socket", options.socket, "Socket of the daemon; overrides the configuration file");
  program.add_option("--port", options.port,
                     "TCP port; overrides the configuration file; 0 selects a free port");
  program.add_flag("--check", options.check, "Check the configuration file, report its errors, and exit");
  program.footer("The server is ready when it has printed 'listening on ADDRESS:PORT'.");
}

ExitCode run(const Options& options) {
  if (const auto code = tools::unreadable(options.config)) return *code;
  document::Problems problems;
  auto settings = load_settings(options.config, problems);
  if (!settings) return tools::refuse(problems);
  if (!options.socket.empty()) settings->socket = options.socket;
  if (options.port) settings->port = *options.port;
  if (options.check) return ExitCode::done;
  Descriptor signals = tools::take_signals({SIGINT, SIGTERM, SIGHUP});
  std::signal(SIGPIPE, SIG_IGN);
  auto listener = net::listen_tcp(settings->address, settings->port);
  if (!listener) return tools::fail(ExitCode::io, listener.error());
  std::printf("listening on %s:%u\n", settings->address.c_str(), unsigned{listener->port});
  std::fflush(stdout);
  Gateway gateway(*settings);
  Server(*settings, gateway, std::move(listener->socket), std::move(signals)).run();
  return ExitCode::done;
}

}  // namespace
}  // namespace softgrip::plc

int main(int argc, char** argv) {
  using namespace softgrip;
  try {
    CLI::App program{"Modbus TCP server that connects PLCs and robot controllers to the socket of softgripd.",
                     "softgrip-plc"};
    plc::Options options;
    plc::add_options(program, options);
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return tools::end_of(program, error, argc, argv);
    }
    return static_cast<int>(plc::run(options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "softgrip-plc: %s\n", error.what());
  }
  return static_cast<int>(ExitCode::failed);
}
