#pragma once
// Time that only passes when somebody sleeps, for commands that move a rig by hand.

#include <limits>

#include "base/clock.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::tools::testing {

class VirtualPace final : public Pace {
 public:
  VirtualPace() { clock.set(1'000'000'000); }
  [[nodiscard]] Nanoseconds now() noexcept override { return clock.now(); }
  void sleep_until(Nanoseconds due) noexcept override {
    if (due > clock.now()) clock.set(due);
  }
  [[nodiscard]] bool stopped() noexcept override { return clock.now() >= stop_at; }

  VirtualClock clock;
  Nanoseconds stop_at = std::numeric_limits<Nanoseconds>::max();
};

}  // namespace softgrip::tools::testing
