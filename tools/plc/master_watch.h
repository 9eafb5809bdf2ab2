#pragma once
// Notices that the master has fallen silent, and keeps the reaction to it until it is confirmed.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the master's heartbeat from its first change on: a master that never writes one is not watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  /// A heartbeat has changed.
  void beat(Nanoseconds now) noexcept {
    look(now);  // a silence that ends before the next look is a silence, too
    changed_ = now;
    noticed_ = false;
  }
  /// Returns true once per silence: it is noticed now. To be called often.
  bool look(Nanoseconds now) noexcept {
    if (noticed_ || !silent(now)) return false;
    noticed_ = true;
    owes_ = true;
    return true;
  }
  [[nodiscard]] bool watched() const noexcept { return changed_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept { return changed_ && now - *changed_ > silence_; }
  /// The reaction to a silence is not confirmed yet. A master that beats again does not change that.
  [[nodiscard]] bool owes() const noexcept { return owes_; }
  void confirm() noexcept { owes_ = false; }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> changed_;
  bool noticed_ = false;  // this silence
  bool owes_ = false;
};

}  // namespace softgrip::plc
