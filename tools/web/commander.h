#pragma once
// Sends the commands of browsers to the daemon over one connection.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "base/time.h"
#include "tools/client/daemon_client.h"

namespace softgrip::web {

/// Converts the JSON body of a browser's request to a request for the daemon. The permitted commands are
/// start, stop, vent, release and acknowledge. Only the command start may contain a sequence and parameters.
/// If the body is invalid, returns an error message.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> command_in(std::string_view body);

/// Sends commands and gives every start its own id. A start whose outcome cannot be sent to the browser must
/// not move the gripper. Such a start is stopped by its id. The stop is repeated, also on a new connection,
/// until a daemon confirms that the start does not run. There are three cases: the response to the start is
/// late; the connection to the daemon or to the browser is lost; the daemon responds that its control loop
/// was silent.
class Commander {
 public:
  /// Largest number of commands that wait for their responses. If this number is reached, the same number of
  /// stop and vent commands may wait in addition.
  static constexpr std::size_t max_pending = 32;

  /// Creates the object and does not connect. `socket` is the path of the daemon's socket for clients that
  /// may move the gripper.
  explicit Commander(const std::string& socket) : may_connect_(!socket.empty()), daemon_(socket) {}

  /// Sends the request and returns a number. take_response() returns the response for this number. The error
  /// has the format of a response of the daemon.
  [[nodiscard]] tl::expected<std::uint64_t, nlohmann::ordered_json> send(nlohmann::ordered_json request,
                                                                         Nanoseconds now);
  /// Returns the complete response of the daemon, once for each number. Returns nullopt while there is no
  /// response. If the daemon cannot be reached, returns an error response that states this.
  [[nodiscard]] std::optional<nlohmann::ordered_json> take_response(std::uint64_t number, Nanoseconds now);
  /// Returns true for a start whose outcome is open: the daemon has not refused the start, and
  /// take_response() has not returned its outcome.
  [[nodiscard]] bool is_open_start(std::uint64_t number) const;
  /// Discards the response with this number. Must be called when the client that waits for this response has
  /// disconnected.
  void abandon(std::uint64_t number);
  /// Reads the responses of the daemon and repeats stop requests. Must be called when the descriptor is
  /// readable, and several times per second.
  void update(Nanoseconds now);
  /// Abandons all pending commands. Must be called before the program ends.
  void abandon_all();
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_.descriptor(); }

 private:
  struct PendingCommand {
    Nanoseconds deadline = 0;
    std::string start_id;  ///< id of a start that may begin or that runs; empty: there is no such start
    std::optional<nlohmann::ordered_json> response;
  };
  /// A start whose outcome cannot be delivered to the browser.
  struct AbandonedStart {
    std::string start_id;
    std::uint64_t stop = 0;  ///< number of the stop request that has no response yet; 0: there is no such
                             ///< request
  };
  [[nodiscard]] std::optional<nlohmann::ordered_json> connect();
  void greet();
  std::uint64_t send_numbered(nlohmann::ordered_json request);
  void process_line(nlohmann::ordered_json line);
  void complete(PendingCommand& pending, nlohmann::ordered_json response);
  void abandon_start(PendingCommand& pending);
  void stop(AbandonedStart& start);
  void retry_stops(Nanoseconds now);
  void handle_disconnect();

  bool may_connect_;
  tools::DaemonLink daemon_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, PendingCommand> pending_;
  std::vector<AbandonedStart> abandoned_;
  Nanoseconds last_retry_at_ = 0;  // time at which retry_stops() last sent stop requests
};

}  // namespace softgrip::web
