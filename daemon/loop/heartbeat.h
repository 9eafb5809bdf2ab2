#pragma once
// Checks that the essential threads are still running.

#include <cstdint>
#include <vector>

#include "model/reading.h"

namespace softgrip::daemon {

/// Checks counters that the threads increase. Each counter has its own time-out: a bus thread may stop for as
/// long as opening a session takes, but a loop may not.
class Heartbeat {
 public:
  /// `patience` has the time-out of each counter [ns]. The times begin with the first call of beats().
  explicit Heartbeat(const std::vector<Nanoseconds>& patience);

  /// Returns false if a counter has not changed for longer than its time-out. `counts` has the counters in
  /// the same order.
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
