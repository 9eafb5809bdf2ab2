#pragma once
// The connection over which browsers command the daemon.

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

/// The request that a browser's body stands for: one of start, stop, vent, release, acknowledge, with what a
/// start has and nothing else. The error is a sentence.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> command_in(std::string_view body);

/// Gives every start an id of its own. A start whose outcome nobody hears must not move the gripper: it is
/// stopped by this id, over the next connection too, until a daemon has confirmed that it does not run. Such
/// a start had no answer in time, lost its connection or its browser, or was answered by a loop that is
/// silent.
class Commander {
 public:
  /// Commands that wait for their answers. As many stops and vents may wait beside them.
  static constexpr std::size_t most_waiting = 32;

  /// `socket` is the daemon's for operating, and outlives this.
  explicit Commander(const std::string& socket) : socket_(socket) {}

  /// Sends it and returns the number under which its answer comes; or what the daemon would say: why not.
  [[nodiscard]] tl::expected<std::uint64_t, nlohmann::ordered_json> send(nlohmann::ordered_json request,
                                                                         Nanoseconds now);
  /// The daemon's whole answer, once; nothing while it is waited for. Without the daemon the answer says so.
  [[nodiscard]] std::optional<nlohmann::ordered_json> take_answer(std::uint64_t number, Nanoseconds now);
  /// True of a start that is not refused and whose outcome take_answer() has not returned.
  [[nodiscard]] bool is_open_start(std::uint64_t number) const;
  /// Nobody waits for it any more.
  void forget(std::uint64_t number);
  /// To be called when the descriptor can be read, and several times a second.
  void look_after(Nanoseconds now);
  /// Nobody waits for anything any more: the program ends.
  void leave();
  /// -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_ ? daemon_->descriptor() : -1; }

 private:
  struct Waiting {
    Nanoseconds give_up = 0;
    std::string start_id;  ///< of a start that may run
    std::optional<nlohmann::ordered_json> answer;
  };
  /// A start whose outcome nobody hears.
  struct GivenUp {
    std::string start_id;
    std::uint64_t stop = 0;  ///< the number of its stop; 0: none is under way
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
  Nanoseconds stopped_at_ = 0;  // by stop_again()
};

}  // namespace softgrip::web
