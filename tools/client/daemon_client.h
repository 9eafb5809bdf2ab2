#pragma once
// A connection to softgripd's socket with one JSON object per line in each direction
// (docs/reference/socket-api.md).

#include <chrono>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "base/exit_code.h"

namespace softgrip::tools {

/// Returns the default path of softgripd's socket: $SOFTGRIP_SOCKET, or the path of the packaged service.
[[nodiscard]] std::string default_socket_path();

/// Returns the text of the problems of a sequence that the daemon reports: "file:line:col: message" for each,
/// on a new line.
[[nodiscard]] std::string listed(const nlohmann::ordered_json& problems);

/// The reason why a request failed, for the user, and the exit code of the program.
struct ClientFailure {
  ExitCode code = ExitCode::io;
  std::string message;
  bool nobody_listens = false;  ///< no daemon listens on this socket
};

class DaemonClient {
 public:
  static constexpr std::chrono::milliseconds longest_answer{5000};

  /// Connects to the daemon. If no daemon runs, the failure explains how to start one.
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect(const std::string& path);
  /// Connects without waiting. Fails if the daemon's queue of unaccepted connections is full. A later request
  /// waits at most `longest_send` until it is sent. With connect(), this limit is `longest_answer`, for
  /// connecting and for each request.
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect_at_once(const std::string& path);
  static constexpr std::chrono::milliseconds longest_send{50};

  /// Sends a request without waiting for the response. If sending fails, the next call of next_line() that
  /// finds no more lines returns the failure. Lines that the daemon sent before it closed the connection are
  /// still returned, and the last one may state the reason. If the daemon does not accept the request in
  /// time, the connection ends.
  void send(const nlohmann::ordered_json& request);
  /// Returns the `result` of a response from next_line(), or a failure if the daemon refused, like ask().
  [[nodiscard]] static tl::expected<nlohmann::ordered_json, ClientFailure> result_of(
      const nlohmann::ordered_json& answer);

  /// Sends a request and returns the `result` of its response. A refusal of the daemon is a failure with
  /// ExitCode::state_refused, a refused sequence with ExitCode::input_refused.
  [[nodiscard]] tl::expected<nlohmann::ordered_json, ClientFailure> ask(
      const nlohmann::ordered_json& request, std::chrono::milliseconds patience = longest_answer);

  /// Returns the next line of the daemon, for example a watched state, or nullopt after `patience`. Each line
  /// has passed parse_reply(). A line that does not pass ends the connection (ExitCode::io).
  [[nodiscard]] tl::expected<std::optional<nlohmann::ordered_json>, ClientFailure> next_line(
      std::chrono::milliseconds patience);

  /// Returns the descriptor for poll().
  [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

 private:
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect(
      const std::string& path, int flags, std::chrono::milliseconds send_limit);
  DaemonClient(Descriptor socket, std::string path) : socket_(std::move(socket)), path_(std::move(path)) {}
  [[nodiscard]] ClientFailure gone() const;
  [[nodiscard]] ClientFailure malformed(const std::string& why);

  Descriptor socket_;
  std::string path_;
  std::string pending_;
  bool deaf_ = false;  // the daemon did not accept a request
};

/// Returns true if a daemon runs on this socket, even if it does not respond: it then controls the board.
[[nodiscard]] bool daemon_runs(const std::string& path);
/// The remedy for a command that cannot run beside the daemon.
inline constexpr const char* stop_the_daemon =
    "softgripd runs and holds the board: stop it first (systemctl stop softgripd)";

}  // namespace softgrip::tools
