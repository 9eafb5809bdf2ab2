#pragma once
// What all subcommands have in common that talk to the daemon.

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

/// Adds --socket, --rig (whose file names the socket) and --json. A rig file that names none ends the
/// program, with a sentence, by a CLI::RuntimeError.
void add_daemon_options(CLI::App& command, DaemonOptions& options);

/// Connects, asks once and returns the result; prints what went wrong.
[[nodiscard]] tl::expected<nlohmann::ordered_json, ExitCode> ask_daemon(
    const DaemonOptions& options, const nlohmann::ordered_json& request);

/// Adds a subcommand that is one request without arguments: `name` is also the daemon's command. Once it was
/// accepted, `done` is printed, or the result as JSON.
void add_plain_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                       const std::string& meaning, std::string done);

/// The same for what ends motion: once the rig stands still, it is said where pressure stays on, and which
/// command ends that; as JSON it is `under_pressure` in the result.
void add_ending_request(CLI::App& program, ExitCode& outcome, const std::string& name,
                        const std::string& meaning, std::string done);

/// One line of JSON on the standard output; bytes that are not UTF-8 are replaced.
void print_json(const nlohmann::ordered_json& json);

}  // namespace softgrip::tools
