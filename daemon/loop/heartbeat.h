#pragma once
// Checks that the threads without which the daemon cannot work are still running.

#include <cstdint>
#include <vector>

#include "model/reading.h"

namespace softgrip::daemon {

/// Checks counters that the threads increase. Each counter has its own time-out. Opening a connection may
/// block the bus thread for a long time, but nothing may block the loop.
class Heartbeat {
 public:
  /// `patience` contains the time-out of each counter [ns]. The time-outs start with the first call of
  /// beats().
  explicit Heartbeat(const std::vector<Nanoseconds>& patience);

  /// Returns false if a counter has not changed for longer than its time-out. `counts` contains the counters
  /// in the order of their time-outs.
  [[nodiscard]] bool beats(Nanoseconds now, const std::vector<std::uint64_t>& counts);

 private:
  struct Counter {
    Nanoseconds patience = 0;
    Nanoseconds grew_at = 0;
    std::uint64_t count = 0;
  };
  std::vector<Counter> counters_;
  bool begun_ = false;
};

}  // namespace softgrip::daemon
