#pragma once
// Connects programs to softgripd's socket. In each direction, every message is one line with a JSON object
// (docs/reference/socket-api.md).
// A gateway opens its connection again after a loss.
// Requests a start with a `start_id` of its own. With this id, a program can stop its own start and does not
// affect the start of another program (docs/reference/socket-api.md, "A stop of one start").
// Checks all lines of the daemon. After the check, all fields that the programs read have the JSON types of
// docs/reference/socket-api.md, so the readers of the fields need no checks of their own.
// Reads fields of the daemon's messages that may be missing, null or of an unexpected JSON type.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "base/exit_code.h"
#include "base/net/line_buffer.h"
#include "base/time.h"

namespace softgrip::tools {

/// Returns the default path of softgripd's socket: $SOFTGRIP_SOCKET, or the path of the packaged service.
[[nodiscard]] std::string default_socket_path();

/// Returns the text of the problems that the daemon found in a sequence. Each problem begins a new line:
/// "file:line:col: message".
[[nodiscard]] std::string problem_list(const nlohmann::ordered_json& problems);

/// The reason why a request failed, as text for the user, and the exit code of the program.
struct ClientFailure {
  ExitCode code = ExitCode::io;
  std::string message;
  bool no_listener = false;  ///< true: no daemon listens on this socket
};

class DaemonClient {
 public:
  static constexpr std::chrono::milliseconds reply_timeout{5000};

  /// Connects to the daemon. If no daemon runs, the failure explains how to start one.
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect(const std::string& path);
  /// Connects without waiting. Fails if the daemon's queue of unaccepted connections is full. Sending a later
  /// request takes at most `send_timeout`. For the function connect() above, this limit is `reply_timeout`.
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect_without_waiting(
      const std::string& path);
  static constexpr std::chrono::milliseconds send_timeout{50};

  /// Sends a request and does not wait for the response. If the daemon does not accept the request in time,
  /// the connection ends. After a failure, next_line() first returns all lines that the daemon sent before
  /// the connection ended, and then the failure. The last of these lines may contain the reason.
  void send(const nlohmann::ordered_json& request);
  /// Returns the `result` of a response that next_line() returned, or a failure if the daemon refused the
  /// request.
  [[nodiscard]] static tl::expected<nlohmann::ordered_json, ClientFailure> result_of(
      const nlohmann::ordered_json& answer);

  /// Sends a request and returns the `result` of its response. Returns a failure with ExitCode::state_refused
  /// if the daemon refuses the request, and with ExitCode::input_refused if it refuses a sequence.
  [[nodiscard]] tl::expected<nlohmann::ordered_json, ClientFailure> call(
      const nlohmann::ordered_json& request, std::chrono::milliseconds timeout = reply_timeout);

  /// Returns the next line of the daemon, for example a status, or nullopt after `timeout`. parse_reply()
  /// checks each line. A malformed line ends the connection and returns a failure with ExitCode::io.
  [[nodiscard]] tl::expected<std::optional<nlohmann::ordered_json>, ClientFailure> next_line(
      std::chrono::milliseconds timeout);

  /// Returns the file descriptor of the socket. The caller uses it for poll().
  [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

 private:
  [[nodiscard]] static tl::expected<DaemonClient, ClientFailure> connect(
      const std::string& path, int flags, std::chrono::milliseconds send_limit);
  DaemonClient(Descriptor socket, std::string path) : socket_(std::move(socket)), path_(std::move(path)) {}
  [[nodiscard]] ClientFailure connection_closed() const;
  [[nodiscard]] ClientFailure malformed(const std::string& why);

  Descriptor socket_;
  std::string path_;
  net::LineBuffer pending_;
  bool send_timed_out_ = false;  // true: the daemon did not accept a request in time
};

/// Returns true if a daemon listens on this socket. The daemon then controls the board, even if it does not
/// respond.
[[nodiscard]] bool daemon_runs(const std::string& path);
/// Advice for a command that was refused because the daemon runs.
inline constexpr const char* stop_the_daemon =
    "softgripd runs and controls the board: first stop softgripd (systemctl stop softgripd), or the other "
    "`softgrip run` that uses the socket of this rig";

/// The connection of a program that never waits for the daemon. After a loss of the connection, the program
/// connects again.
class DaemonLink {
 public:
  explicit DaemonLink(std::string path) : path_(std::move(path)) {}
  /// Connects if there is no connection, but tries at most once every 250 ms. Returns true if the connection
  /// is new.
  [[nodiscard]] bool connect(Nanoseconds now);
  /// Connects if there is no connection. If this fails, returns the reason.
  [[nodiscard]] std::optional<ClientFailure> connect_now();
  /// Passes the lines that have arrived from the daemon to `on_line`. Returns false if the connection has
  /// ended.
  [[nodiscard]] bool receive_lines(const std::function<void(nlohmann::ordered_json&)>& on_line);
  void disconnect() noexcept { client_.reset(); }
  [[nodiscard]] explicit operator bool() const noexcept { return client_.has_value(); }
  /// Sends a request to the daemon. There must be a connection.
  void send(const nlohmann::ordered_json& request) { client_->send(request); }
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return client_ ? client_->descriptor() : -1; }

 private:
  std::string path_;
  std::optional<DaemonClient> client_;
  Nanoseconds last_attempt_at_ = 0;  // time of the last attempt to connect by connect()
};

/// Returns a new id for a start that no other start has.
[[nodiscard]] std::string new_start_id();

/// Checks that the daemon supports `start_id`, so that a program can stop its own start alone. Returns
/// nullopt if the daemon supports it, otherwise the reason why the program must not request a start.
[[nodiscard]] std::optional<ClientFailure> check_start_id_support(DaemonClient& client);

/// Returns the request to stop the start with this id and no other start.
[[nodiscard]] nlohmann::ordered_json stop_request_for(const std::string& start_id);

/// Returns true if the daemon's reply to the request of stop_request_for() confirms that the start does not
/// run and will not begin.
[[nodiscard]] bool confirms_stop(const nlohmann::ordered_json& reply);

/// Returns true if this reply of the daemon refuses the start. Returns false if the reply states that the
/// control loop did not respond in time, because the loop may still begin this start.
[[nodiscard]] bool refuses_start(const nlohmann::ordered_json& reply);

/// Parses a line of the daemon: a reply, a state or an event. The error describes the malformed part. An
/// unknown key may have a value of any type, because a newer daemon may send additional keys.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> parse_reply(std::string_view line);

/// Returns the text at `key` without control characters, shortened to `most` characters. Returns "-" if there
/// is no text.
[[nodiscard]] std::string text_at(const nlohmann::ordered_json& json, const char* key,
                                  std::size_t most = 200);
[[nodiscard]] std::optional<double> number_at(const nlohmann::ordered_json& json, const char* key);
/// Returns the object at `key`. Returns an empty object if there is no value, or if the value is not an
/// object.
[[nodiscard]] const nlohmann::ordered_json& object_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace softgrip::tools
