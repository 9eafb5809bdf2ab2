#pragma once
// Whether the master still lives.

#include <cstdint>
#include <optional>

#include "base/time.h"

namespace softgrip::plc {

/// Looks at the master's heartbeat register from the first time that it changes: who writes none is not
/// watched.
class MasterWatch {
 public:
  explicit MasterWatch(Nanoseconds silence) noexcept : silence_(silence) {}

  void beat(std::uint16_t value, Nanoseconds now) noexcept {
    if (value == value_) return;
    value_ = value;
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
  std::uint16_t value_ = 0;
  std::optional<Nanoseconds> changed_;
  bool told_ = false;
};

}  // namespace softgrip::plc
