#pragma once
// Ctrl-C and its like as a question that a motion asks before every exchange.

#include "daemon/service/signals.h"

namespace softgrip::tools {

/// Holds back every signal that would end the process while it lives.
class StopSignals {
 public:
  /// True from the first of them on. Does not wait.
  [[nodiscard]] bool came() noexcept { return came_ = came_ || signals_.wait(0) != 0; }

 private:
  daemon::Signals signals_;
  bool came_ = false;
};

}  // namespace softgrip::tools
