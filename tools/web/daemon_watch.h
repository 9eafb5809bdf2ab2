#pragma once
// Maintains the connection to the daemon that provides the data of the page. One connection serves any number
// of browsers.

#include "base/time.h"
#include "tools/client/daemon_client.h"
#include "tools/web/live_state.h"

namespace softgrip::web {

class DaemonWatch {
 public:
  /// Creates the object and does not connect. `socket` is the path of the daemon's read-only socket. `state`
  /// must outlive this object.
  DaemonWatch(const std::string& socket, LiveState& state) : state_(state), daemon_(socket) {}

  /// Reads the daemon's lines, sends the requests that are due, and reconnects after a loss. Must be called
  /// when the descriptor is readable, and several times per second.
  void update(Nanoseconds now);
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_.descriptor(); }

 private:
  void send_initial_requests(Nanoseconds now);
  void process_line(nlohmann::ordered_json line, Nanoseconds now);
  void process_result(std::uint64_t id, nlohmann::ordered_json result);
  void send_due_requests(Nanoseconds now);

  LiveState& state_;
  tools::DaemonLink daemon_;
  Nanoseconds last_status_at_ = 0;  // time of the last state that the daemon has sent
  Nanoseconds statistics_due_ = 0;
  Nanoseconds sequences_due_ = 0;
  std::string started_at_;  // start time of the daemon process that sent the last received events
  std::uint64_t last_event_ = 0;
};

}  // namespace softgrip::web
