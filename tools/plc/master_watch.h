#pragma once
// Detects that the client (Modbus master) is silent. After a silence, a stop or vent is required until the
// daemon has confirmed the stop or vent.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the heartbeat of the client, starting with the first change of the heartbeat. A client whose
/// heartbeat never changes is not watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  /// Notes that the heartbeat has changed. Must be called at each change of the client's heartbeat.
  void beat(Nanoseconds now) noexcept {
    look(now);  // detects a silence that this heartbeat ends, before the next call of look()
    changed_ = now;
    noticed_ = false;
  }
  /// Returns true once per silence, at the first call after the silence has exceeded its limit. Must be
  /// called several times within this limit.
  bool look(Nanoseconds now) noexcept {
    if (noticed_ || !silent(now)) return false;
    noticed_ = true;
    owes_ = true;
    return true;
  }
  [[nodiscard]] bool watched() const noexcept { return changed_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept { return changed_ && now - *changed_ > silence_; }
  /// Returns true from the detection of a silence until the call of confirm(). A new heartbeat does not
  /// change the result.
  [[nodiscard]] bool owes() const noexcept { return owes_; }
  void confirm() noexcept { owes_ = false; }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> changed_;
  bool noticed_ = false;  // true: look() has already reported the present silence
  bool owes_ = false;
};

}  // namespace softgrip::plc
