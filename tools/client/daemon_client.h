#pragma once
// A connection to softgripd's socket: one JSON object per line each way (docs/reference/socket-api.md).

#include <chrono>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "base/exit_code.h"

namespace softgrip::tools {

/// Where softgripd listens unless told otherwise: $SOFTGRIP_SOCKET, or the packaged service's path.
[[nodiscard]] std::string default_socket_path();

/// "file:line:col: message" of each problem that the daemon has with a sequence, each on a line begun anew.
[[nodiscard]] std::string listed(const nlohmann::ordered_json& problems);

/// Why a request came to nothing, for the user, and what the program exits with.
struct ClientFailure {
  ExitCode code = ExitCode::io;
  std::string message;
  bool nobody_listens = false;  ///< no daemon runs on that socket
};

class DaemonClient {
 public:
  static constexpr std::chrono::milliseconds longest_answer{5000};

  /// The failure says what to do when no daemon is there.
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect(const std::string& path);
  /// For a program that must not wait: fails if the daemon has too many connections to accept, and a request
  /// waits for `longest_send` at most. connect(), and the requests after it, wait for `longest_answer`.
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect_at_once(const std::string& path);
  static constexpr std::chrono::milliseconds longest_send{50};

  /// Sends a request and waits for nothing. What cannot be sent shows itself in next_line(): the reason
  /// stands in what the daemon says last, if it gave one before it hung up. The connection ends if the daemon
  /// does not take the request.
  void send(const nlohmann::ordered_json& request);
  /// The `result` of an answer that next_line() brought; a refusal as a failure, as of ask().
  [[nodiscard]] static tl::expected<nlohmann::ordered_json, ClientFailure> result_of(
      const nlohmann::ordered_json& answer);

  /// Sends a request and returns the `result` of its answer. Refusals of the daemon are failures with
  /// ExitCode::state_refused, refused sequences with ExitCode::input_refused.
  [[nodiscard]] tl::expected<nlohmann::ordered_json, ClientFailure> ask(
      const nlohmann::ordered_json& request, std::chrono::milliseconds patience = longest_answer);

  /// The next line that the daemon sends by itself (a watched state); nothing when `patience` ends first.
  /// Each line has passed parse_reply(). One that does not pass ends the connection (ExitCode::io).
  [[nodiscard]] tl::expected<std::optional<nlohmann::ordered_json>, ClientFailure> next_line(
      std::chrono::milliseconds patience);

  /// For poll().
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
  bool deaf_ = false;  // the daemon did not take a request
};

/// Whether a daemon runs on that socket, be it that it does not answer: it holds the board then.
[[nodiscard]] bool daemon_runs(const std::string& path);
/// What to do about one that must not.
inline constexpr const char* stop_the_daemon =
    "softgripd runs and holds the board: stop it first (systemctl stop softgripd)";

}  // namespace softgrip::tools
