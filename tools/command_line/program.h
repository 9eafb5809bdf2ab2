#pragma once
// Contains the common code of the programs: parsing of the command line, the messages about errors in the
// command line, and the options and signals of the programs that serve until a signal ends them
// (softgrip-web, softgrip-plc and softgrip-rig).

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>

#include "base/descriptor.h"
#include "base/exit_code.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace softgrip::tools {

/// Prints help or version if the user requested it. Otherwise prints the error and the existing command or
/// option with the most similar name. Returns the exit code of the program: 0, 2, or the code of a
/// CLI::RuntimeError.
[[nodiscard]] int end_of(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv);

/// Makes every option of every command refuse a value that begins with "--". Such a value is the name of the
/// next option, so the value of the option is missing. Call this function after all options were added.
void refuse_options_as_values(CLI::App& program);

/// Name, purpose and functions of a program.
struct ServerProgram {
  std::string name;
  std::string purpose;  ///< first line of --help
  std::function<void(CLI::App&)> add_options;
  std::function<ExitCode()> run;  ///< called after the command line was parsed
};

/// Adds --version and the options of the program, parses the command line and runs the program. Prints an
/// exception to the standard error. Returns the exit code of the process.
[[nodiscard]] int run_server_program(const ServerProgram& program, int argc, char** argv);

/// The options of a gateway between softgripd's socket and a network.
struct GatewayOptions {
  std::string config;
  std::string socket;
  std::optional<std::uint16_t> port;
  bool check = false;
};

/// Adds --config, --socket, --port, the options that `add_others` adds, and --check. `file` is the name of
/// the configuration file.
void add_gateway_options(
    CLI::App& program, GatewayOptions& options, const std::string& file, const std::string& config_help,
    const std::string& socket_help, const std::function<void()>& add_others = [] {});

/// Takes the signals that end a server (SIGINT, SIGTERM, SIGHUP) and `others`, as take_signals() does.
/// Ignores SIGPIPE, because a failed write already shows that a client has disconnected.
[[nodiscard]] Descriptor take_server_signals(std::initializer_list<int> others = {});

/// Prints the message that the server is ready, and flushes the standard output.
void say_ready(const std::string& message);

}  // namespace softgrip::tools
