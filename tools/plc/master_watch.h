#pragma once
// Whether the master still lives.

#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Watches the master's heartbeat from its first change on: a master that never writes one is not watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  /// A heartbeat has changed.
  void beat(Nanoseconds now) noexcept {
    changed_ = now;
    told_ = false;
  }
  [[nodiscard]] bool watched() const noexcept { return changed_.has_value(); }
  [[nodiscard]] bool silent(Nanoseconds now) const noexcept { return changed_ && now - *changed_ > silence_; }
  /// True once per silence.
  [[nodiscard]] bool falls_silent(Nanoseconds now) noexcept {
    if (told_ || !silent(now)) return false;
    told_ = true;
    return true;
  }

 private:
  Nanoseconds silence_;
  std::optional<Nanoseconds> changed_;
  bool told_ = false;
};

}  // namespace softgrip::plc
