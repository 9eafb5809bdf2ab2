#include "tools/command_line/server_program.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <vector>

#include "base/version.h"
#include "tools/command_line/configuration.h"
#include "tools/command_line/terminal.h"
#include "tools/command_line/usage.h"

namespace softgrip::tools {

int run_server_program(const ServerProgram& program, int argc, char** argv) {
  try {
    CLI::App app{program.purpose, program.name};
    app.set_version_flag("--version", (program.name + " ").append(software_version()));
    program.add_options(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return end_of(app, error, argc, argv);
    }
    return static_cast<int>(program.run());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program.name.c_str(), error.what());
  }
  return static_cast<int>(ExitCode::failed);
}

void add_gateway_options(CLI::App& program, GatewayOptions& options, const std::string& file,
                         const std::string& config_help, const std::string& socket_help,
                         const std::function<void()>& add_others) {
  options.config = configuration_path(file);
  program.add_option("--config", options.config, config_help)->capture_default_str();
  program.add_option("--socket", options.socket, socket_help);
  program.add_option("--port", options.port,
                     "TCP port; overrides the configuration file; 0 selects a free port");
  add_others();
  program.add_flag("--check", options.check, "Check the configuration file, report its errors, and exit");
}

Descriptor take_server_signals(std::initializer_list<int> others) {
  std::vector<int> signals{SIGINT, SIGTERM, SIGHUP};
  signals.insert(signals.end(), others);
  std::signal(SIGPIPE, SIG_IGN);
  return take_signals(signals);
}

void say_ready(const std::string& message) {
  std::fputs(message.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace softgrip::tools
