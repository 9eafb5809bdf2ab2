#pragma once
// The common part of all subcommands that communicate with the daemon.

#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/daemon_client.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

struct DaemonOptions {
  std::string socket;
  bool json = false;
};

/// Adds --socket, --rig (the rig file names the socket) and --json. If the rig file names no socket, the
/// program prints a sentence and ends with a CLI::RuntimeError.
void add_daemon_options(CLI::App& command, DaemonOptions& options);

/// Connects, sends one request and returns the result. Prints the message of a failure.
[[nodiscard]] tl::expected<nlohmann::ordered_json, ExitCode> ask_daemon(
    const DaemonOptions& options, const nlohmann::ordered_json& request);

/// Adds a subcommand that sends one request without arguments. `name` is also the command of the daemon.
/// After the daemon has accepted, it prints `done`, or the result as JSON.
void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning, std::string done);

/// Adds a subcommand that ends motion, like add_plain_request(). When the rig is idle, it also prints the
/// pressurised fingers and the command that vents them. In JSON, this is `under_pressure` in the result.
void add_ending_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                        const std::string& meaning, std::string done);

/// Prints one line of JSON to the standard output. Bytes that are not UTF-8 are replaced.
void print_json(const nlohmann::ordered_json& json);

}  // namespace softgrip::tools
