#pragma once
// Maintains the connection that provides the displayed data of the daemon. One connection serves any number
// of browsers.

#include <optional>

#include "base/time.h"
#include "tools/client/daemon_client.h"
#include "tools/web/live_state.h"

namespace softgrip::web {

class DaemonWatch {
 public:
  /// `socket` is the path of the daemon's read-only socket. All references must outlive this object.
  DaemonWatch(const std::string& socket, LiveState& state) : socket_(socket), state_(state) {}

  /// Reads the daemon's lines, sends requests that are due, and reconnects. Call it when the descriptor is
  /// readable, and several times per second.
  void look_after(Nanoseconds now);
  /// Returns the descriptor of the connection, or -1.
  [[nodiscard]] int descriptor() const noexcept { return daemon_ ? daemon_->descriptor() : -1; }

 private:
  void connect(Nanoseconds now);
  void take(nlohmann::ordered_json line, Nanoseconds now);
  void take_result(std::uint64_t id, nlohmann::ordered_json result);
  void ask_what_is_due(Nanoseconds now);

  const std::string& socket_;
  LiveState& state_;
  std::optional<tools::DaemonClient> daemon_;
  Nanoseconds tried_at_ = 0;  // last attempt to connect
  Nanoseconds heard_at_ = 0;  // last state received
  Nanoseconds statistics_due_ = 0;
  Nanoseconds sequences_due_ = 0;
  std::string started_at_;  // start time of the daemon whose events were received last
  std::uint64_t last_event_ = 0;
};

}  // namespace softgrip::web
