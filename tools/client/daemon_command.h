#pragma once
// Options, requests and output of all subcommands that connect to the daemon.

#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/daemon_client.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

struct DaemonOptions {
  std::string socket;
  bool json = false;
};

/// Adds the options --socket, --rig and --json. With --rig, the path of the socket is read from the rig file.
/// If the rig file contains no path, the program prints a sentence and ends with a CLI::RuntimeError.
void add_daemon_options(CLI::App& command, DaemonOptions& options);

/// Connects to the daemon, sends one request and returns the result of the request. If this fails, prints the
/// message of the failure.
[[nodiscard]] tl::expected<nlohmann::ordered_json, ExitCode> call_daemon(
    const DaemonOptions& options, const nlohmann::ordered_json& request);

/// Adds a subcommand that sends one request without arguments. `name` is the name of the subcommand and of
/// the request. After the daemon has accepted the request, the subcommand prints `done`, or the result as
/// JSON.
void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning, std::string done);
/// Adds a subcommand that sends one request without arguments. After the daemon has accepted the request, the
/// subcommand prints the sentence that `done` returns for the result.
void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning,
                       std::function<std::string(const nlohmann::ordered_json& result)> done);

/// Adds a subcommand that ends motion, in the same way as add_plain_request(). When the rig is idle, the
/// subcommand also prints the pressurised fingers and the command that vents them. With --json, the result
/// contains the pressurised fingers as `under_pressure`.
void add_ending_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                        const std::string& meaning, std::string done);

/// Prints one line of JSON to the standard output. Bytes that are not UTF-8 are replaced.
void print_json(const nlohmann::ordered_json& json);

}  // namespace softgrip::tools
