#pragma once
// Detects that the client (Modbus master) is silent, and remembers that a reaction is required until it is
// confirmed.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the heartbeat of the client from its first change on. A client without a heartbeat is not watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  /// Call it when the heartbeat of the client has changed.
  void beat(Nanoseconds now) noexcept {
    look(now);  // also detects a silence that ends before the next call
    changed_ = now;
    noticed_ = false;
  }
  /// Returns true once per silence: at the first call after the silence has become too long. Call it
  /// frequently.
  bool look(Nanoseconds now) noexcept {
    if (noticed_ || !silent(now)) return false;
    noticed_ = true;
    owes_ = true;
    return true;
  }
  [[nodiscard]] bool watched() const noexcept { return changed_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept { return changed_ && now - *changed_ > silence_; }
  /// Returns true until the reaction to the silence is confirmed, even if the heartbeat has resumed before.
  [[nodiscard]] bool owes() const noexcept { return owes_; }
  void confirm() noexcept { owes_ = false; }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> changed_;
  bool noticed_ = false;  // true: look() has already reported the present silence
  bool owes_ = false;
};

}  // namespace softgrip::plc
