#pragma once
// Virtual time for commands that move a rig without a daemon. The time advances only during sleeps.

#include <limits>

#include "base/clock.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::tools::testing {

struct VirtualTime {
  VirtualTime() { clock.set(1'000'000'000); }
  /// Returns a function that requests a stop when the time `stop_at` is reached.
  [[nodiscard]] StopRequest stop() {
    return [this] { return clock.now() >= stop_at; };
  }

  VirtualClock clock;
  Nanoseconds stop_at = std::numeric_limits<Nanoseconds>::max();
};

}  // namespace softgrip::tools::testing
