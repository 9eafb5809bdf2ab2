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
  static constexpr std::size_t most_waiting = 32;

  /// Creates the object and does not connect. `socket` is the path of the daemon's socket for clients that
  /// may move the gripper.
  explicit Commander(const std::string& socket) : may_connect_(!socket.empty()), daemon_(socket) {}

  /// Sends the request and returns a number. take_answer() returns the response for this number. The error
  /// has the format of a response of the daemon.
  [[nodiscard]] tl::expected<std::uint64_t, nlohmann::ordered_json> send(nlohmann::ordered_json request,
                                                                         Nanoseconds now);
  /// Returns the complete response of the daemon, once for each number. Returns nullopt while there is no
  /// response. If the daemon cannot be reached, returns an error response that states this.
  [[nodiscard]] std::optional<nlohmann::ordered_json> take_answer(std::uint64_t number, Nanoseconds now);
  /// Returns true for a start whose outcome is open: the daemon has not refused the start, and take_answer()
  /// has not returned its outcome.
  [[nodiscard]] bool is_open_start(std::uint64_t number) const;
  /// Discards the response with this number. Must be called when the client that waits for this response has
  /// disconnected.
  void forget(std::uint64_t number);
  /// Reads the responses of the daemon and repeats stop requests. Must be called when the descriptor is
  /// readable, and several times per second.
  void look_after(Nanoseconds now);
  /// Gives up all waiting commands. Must be called before the program ends.
  void leave();
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_.descriptor(); }

 private:
  struct Waiting {
    Nanoseconds give_up = 0;
    std::string start_id;  ///< id of a start that may begin or that runs; empty: there is no such start
    std::optional<nlohmann::ordered_json> answer;
  };
  /// A start whose outcome cannot be delivered to the browser.
  struct GivenUp {
    std::string start_id;
    std::uint64_t stop = 0;  ///< number of the stop request that has no response yet; 0: there is no such
                             ///< request
  };
  [[nodiscard]] std::optional<nlohmann::ordered_json> connect();
  std::uint64_t send_numbered(nlohmann::ordered_json request);
  void take(nlohmann::ordered_json line);
  void end(Waiting& waiting, nlohmann::ordered_json answer);
  void give_up(Waiting& waiting);
  void stop(GivenUp& start);
  void stop_again(Nanoseconds now);
  void lose();

  bool may_connect_;
  tools::DaemonLink daemon_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, Waiting> waiting_;
  std::vector<GivenUp> given_up_;
  Nanoseconds stopped_at_ = 0;  // time at which stop_again() last sent stop requests
};

}  // namespace softgrip::web
