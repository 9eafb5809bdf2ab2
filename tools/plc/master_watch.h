#pragma once
// Detects that the client (Modbus master) is silent. A stop or vent is then required until the daemon has
// confirmed it.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the heartbeat of the client, beginning with its first change. A client whose heartbeat never
/// changes is not watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  /// Call this function when the heartbeat of the client has changed.
  void beat(Nanoseconds now) noexcept {
    look(now);  // detects a silence that ends with this heartbeat, before the next call of look()
    changed_ = now;
    noticed_ = false;
  }
  /// Returns true once per silence: at the first call after the silence has exceeded its limit. Call this
  /// function frequently.
  bool look(Nanoseconds now) noexcept {
    if (noticed_ || !silent(now)) return false;
    noticed_ = true;
    owes_ = true;
    return true;
  }
  [[nodiscard]] bool watched() const noexcept { return changed_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept { return changed_ && now - *changed_ > silence_; }
  /// Returns true from the detection of a silence until confirm(), even if the heartbeat has resumed before.
  [[nodiscard]] bool owes() const noexcept { return owes_; }
  void confirm() noexcept { owes_ = false; }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> changed_;
  bool noticed_ = false;  // true: look() has already reported the present silence
  bool owes_ = false;
};

}  // namespace softgrip::plc
