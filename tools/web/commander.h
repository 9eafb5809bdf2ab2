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

/// Converts the body of a browser's request to a daemon request: start, stop, vent, release or acknowledge.
/// Only a start has a sequence and parameters. The error is a sentence.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> command_in(std::string_view body);

/// Gives every start its own id. A start without a receiver for its outcome must not move the gripper. It is
/// stopped by its id until a daemon confirms that it does not run, also over a later connection. This applies
/// to a start that had no response in time, lost its connection or its browser, or was answered while the
/// control loop was silent.
class Commander {
 public:
  /// Largest number of commands that wait for their responses. As many stops and vents may wait in addition.
  /// addition.
  static constexpr std::size_t most_waiting = 32;

  /// `socket` is the path of the daemon's operating socket and must outlive this object.
  explicit Commander(const std::string& socket) : socket_(socket) {}

  /// Sends the request and returns the number of its response. The error is the response that the daemon
  /// would give.
  [[nodiscard]] tl::expected<std::uint64_t, nlohmann::ordered_json> send(nlohmann::ordered_json request,
                                                                         Nanoseconds now);
  /// Returns the daemon's complete response once, or nullopt while it is pending. If the daemon cannot be
  /// reached, the response says so.
  [[nodiscard]] std::optional<nlohmann::ordered_json> take_answer(std::uint64_t number, Nanoseconds now);
  /// Returns true for a start that was not refused and whose outcome take_answer() has not returned.
  [[nodiscard]] bool is_open_start(std::uint64_t number) const;
  /// The receiver of this response has gone.
  void forget(std::uint64_t number);
  /// Processes the connection. Call it when the descriptor is readable, and several times per second.
  void look_after(Nanoseconds now);
  /// Gives up all commands, because the program ends.
  void leave();
  /// -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_ ? daemon_->descriptor() : -1; }

 private:
  struct Waiting {
    Nanoseconds give_up = 0;
    std::string start_id;  ///< of a start that may run
    std::optional<nlohmann::ordered_json> answer;
  };
  /// A start whose outcome has no receiver.
  struct GivenUp {
    std::string start_id;
    std::uint64_t stop = 0;  ///< number of its stop request; 0: none is pending
  };
  [[nodiscard]] std::optional<nlohmann::ordered_json> connect();
  std::uint64_t send_numbered(nlohmann::ordered_json request);
  void take(nlohmann::ordered_json line);
  void end(Waiting& waiting, nlohmann::ordered_json answer);
  void give_up(Waiting& waiting);
  void stop(GivenUp& start);
  void stop_again(Nanoseconds now);
  void lose();

  const std::string& socket_;
  std::optional<tools::DaemonClient> daemon_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, Waiting> waiting_;
  std::vector<GivenUp> given_up_;
  Nanoseconds stopped_at_ = 0;  // time of the last stop_again()
};

}  // namespace softgrip::web
