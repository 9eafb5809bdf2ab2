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
#include "tools/client/daemon_link.h"

namespace softgrip::web {

/// Converts the JSON body of a browser's request to a request for the daemon. The permitted commands are
/// start, stop, vent, release and acknowledge. Only the command start may contain a sequence and parameters.
/// If the body is invalid, returns an error message.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> command_in(std::string_view body);

/// Sends commands and gives every start its own id. If the outcome of a start cannot be sent to the browser,
/// the start must not move the gripper. It is then stopped by its id until a daemon confirms that it is not
/// running, even over a later connection. This happens if the response to the start is late, if the
/// connection to the daemon or to the browser is lost, or if the daemon responds that its control loop was
/// silent.
class Commander {
 public:
  /// Largest number of commands that wait for their responses. If it is reached, the same number of further
  /// stop and vent commands may wait.
  static constexpr std::size_t most_waiting = 32;

  /// Creates the object without connecting. `socket` is the path of the daemon's socket for operation.
  explicit Commander(const std::string& socket) : may_connect_(!socket.empty()), daemon_(socket) {}

  /// Sends the request and returns a number, with which take_answer() finds its response. The error has the
  /// format of a response of the daemon.
  [[nodiscard]] tl::expected<std::uint64_t, nlohmann::ordered_json> send(nlohmann::ordered_json request,
                                                                         Nanoseconds now);
  /// Returns the complete response of the daemon, once for each number. Returns nullopt while the response is
  /// pending. If the daemon cannot be reached, returns an error response that says so.
  [[nodiscard]] std::optional<nlohmann::ordered_json> take_answer(std::uint64_t number, Nanoseconds now);
  /// Returns true if the request is a start that the daemon has not refused and whose outcome take_answer()
  /// has not returned.
  [[nodiscard]] bool is_open_start(std::uint64_t number) const;
  /// Call this function when the client that waits for this response has disconnected.
  void forget(std::uint64_t number);
  /// Reads the responses of the daemon and repeats stop requests. Call this function when the descriptor is
  /// readable, and several times per second.
  void look_after(Nanoseconds now);
  /// Gives up all waiting commands. Call this function before the program ends.
  void leave();
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_.descriptor(); }

 private:
  struct Waiting {
    Nanoseconds give_up = 0;
    std::string start_id;  ///< id of a start that may begin or run; empty: none
    std::optional<nlohmann::ordered_json> answer;
  };
  /// A start whose outcome cannot be delivered to the browser.
  struct GivenUp {
    std::string start_id;
    std::uint64_t stop = 0;  ///< number of the stop request without a response; 0: none
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
  Nanoseconds stopped_at_ = 0;  // time at which stop_again() last sent requests
};

}  // namespace softgrip::web
