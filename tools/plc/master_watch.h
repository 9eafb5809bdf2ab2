#pragma once
// Detects that the client (Modbus master) is silent, and stores the pending reaction until it is confirmed.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the heartbeat of the client from its first change on. A client without a heartbeat is not watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  /// Call it when a heartbeat has changed.
  void beat(Nanoseconds now) noexcept {
    look(now);  // also detects a silence that ends before the next call
    changed_ = now;
    noticed_ = false;
  }
  /// Returns true once per silence, when it is detected. Call it frequently.
  bool look(Nanoseconds now) noexcept {
    if (noticed_ || !silent(now)) return false;
    noticed_ = true;
    owes_ = true;
    return true;
  }
  [[nodiscard]] bool watched() const noexcept { return changed_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept { return changed_ && now - *changed_ > silence_; }
  /// Returns true until the reaction to a silence is confirmed, even if the heartbeat has resumed.
  [[nodiscard]] bool owes() const noexcept { return owes_; }
  void confirm() noexcept { owes_ = false; }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> changed_;
  bool noticed_ = false;  // the present silence was detected
  bool owes_ = false;
};

}  // namespace softgrip::plc
