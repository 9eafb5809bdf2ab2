#pragma once
// Checks that the essential threads are still running.

#include <cstdint>
#include <vector>

#include "model/reading.h"

namespace softgrip::daemon {

/// Watches counters that their threads raise. Each has its own patience: a bus thread may rightly stand still
/// as long as opening a session may take, a loop may not.
class Heartbeat {
 public:
  /// One patience per counter. Time begins with the first beats().
  explicit Heartbeat(const std::vector<Nanoseconds>& patience);

  /// One count per counter, in the same order. False as soon as one of them has stood still for longer than
  /// its patience, however far the others are behind or ahead.
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
