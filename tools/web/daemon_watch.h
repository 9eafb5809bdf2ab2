#pragma once
// The one connection over which everything that is shown comes from the daemon, however many browsers look.

#include <optional>

#include "base/time.h"
#include "tools/client/daemon_client.h"
#include "tools/web/live_state.h"

namespace softgrip::web {

class DaemonWatch {
 public:
  /// `socket` is the daemon's for looking. References outlive it.
  DaemonWatch(const std::string& socket, LiveState& state) : socket_(socket), state_(state) {}

  /// To be called when the descriptor can be read, and several times a second: lines of the daemon, requests
  /// that are due, connecting anew.
  void look_after(Nanoseconds now);
  /// -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_ ? daemon_->descriptor() : -1; }

 private:
  void connect(Nanoseconds now);
  void take(nlohmann::ordered_json line, Nanoseconds now);
  void take_result(std::uint64_t id, nlohmann::ordered_json result);
  void ask_what_is_due(Nanoseconds now);

  const std::string& socket_;
  LiveState& state_;
  std::optional<tools::DaemonClient> daemon_;
  Nanoseconds tried_at_ = 0;  // to connect
  Nanoseconds heard_at_ = 0;  // a state
  Nanoseconds statistics_due_ = 0;
  Nanoseconds sequences_due_ = 0;
  std::string started_at_;  // of the daemon whose events were heard last
  std::uint64_t last_event_ = 0;
};

}  // namespace softgrip::web
