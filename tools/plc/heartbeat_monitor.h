#pragma once
// Detects that the client (Modbus master) is silent. After a silence, the reaction that the file selects
// (stop, vent or release) is required until the daemon has confirmed it.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the heartbeat of the client, starting with the first change of the heartbeat. A client whose
/// heartbeat never changes is not watched.
class HeartbeatMonitor {
 public:
  explicit HeartbeatMonitor(Nanoseconds silence) noexcept : silence_(silence) {}

  /// Notes that the heartbeat has changed. Must be called at each change of the client's heartbeat.
  void on_change(Nanoseconds now) noexcept {
    check(now);  // detects a silence that this heartbeat ends, before the next call of check()
    last_change_ = now;
    reported_ = false;
  }
  /// Returns true once per silence, at the first call after the silence has exceeded its limit. Must be
  /// called several times within this limit.
  bool check(Nanoseconds now) noexcept {
    if (reported_ || !silent(now)) return false;
    reported_ = true;
    stop_required_ = true;
    return true;
  }
  [[nodiscard]] bool active() const noexcept { return last_change_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept {
    return last_change_ && now - *last_change_ > silence_;
  }
  /// Returns true from the detection of a silence until the call of confirm(). A new heartbeat does not
  /// change the result.
  [[nodiscard]] bool stop_required() const noexcept { return stop_required_; }
  void confirm() noexcept { stop_required_ = false; }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> last_change_;
  bool reported_ = false;  // true: check() has already reported the present silence
  bool stop_required_ = false;
};

}  // namespace softgrip::plc
