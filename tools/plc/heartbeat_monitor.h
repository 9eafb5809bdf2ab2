#pragma once
// Detects that a client (Modbus master) is silent. After a silence, the reaction that the file selects
// (stop, vent or release) is required until the daemon has confirmed it.

#include <algorithm>
#include <map>
#include <string>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the heartbeat of each client, starting with the first change of this heartbeat. A client is
/// identified by its numeric address. A client whose heartbeat never changes is not watched.
class HeartbeatMonitor {
 public:
  enum class State { not_watched, alive, silent };

  explicit HeartbeatMonitor(Nanoseconds silence) noexcept : silence_(silence) {}

  /// Notes that the heartbeat of a client has changed. Must be called at each change. check(now) must be
  /// called before, because the heartbeat may end a silence that is not detected yet.
  void on_change(const std::string& address, Nanoseconds now) { watched_[address] = {now, false}; }
  /// Returns true once per silence of each client, at the first call after the silence has exceeded its
  /// limit. Must be called several times within this limit.
  bool check(Nanoseconds now) noexcept {
    bool found = false;
    for (auto& [address, heartbeat] : watched_) {
      if (heartbeat.reported || !is_silent(heartbeat, now)) continue;
      heartbeat.reported = found = true;
    }
    stop_required_ = stop_required_ || found;
    return found;
  }
  /// Returns the state of a client. The state of a client that is not watched is `silent` if any watched
  /// client is silent, and otherwise `alive` if there is a watched client.
  [[nodiscard]] State state_of(const std::string& address, Nanoseconds now) const {
    if (watched_.empty()) return State::not_watched;
    const auto silent = [&](const auto& entry) { return is_silent(entry.second, now); };
    const auto own = watched_.find(address);
    const bool any =
        own != watched_.end() ? silent(*own) : std::any_of(watched_.begin(), watched_.end(), silent);
    return any ? State::silent : State::alive;
  }
  /// Returns true from the detection of a silence until the call of confirm(). A new heartbeat does not
  /// change the result.
  [[nodiscard]] bool stop_required() const noexcept { return stop_required_; }
  void confirm() noexcept { stop_required_ = false; }

  struct Heartbeat {
    Nanoseconds last_change;
    bool reported;  ///< true: check() has already reported the present silence
  };
  /// Returns the watched heartbeats by address. The list of allowed addresses limits their number.
  [[nodiscard]] const std::map<std::string, Heartbeat>& watched() const noexcept { return watched_; }

 private:
  [[nodiscard]] bool is_silent(const Heartbeat& heartbeat, Nanoseconds now) const noexcept {
    return now - heartbeat.last_change > silence_;
  }

  Nanoseconds silence_;
  std::map<std::string, Heartbeat> watched_;
  bool stop_required_ = false;
};

}  // namespace softgrip::plc
