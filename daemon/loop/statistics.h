#pragma once
// Statistics of the loop and the bus, which are always recorded. Loop and bus write them, and any thread may
// read them.

#include <atomic>
#include <cstdint>

#include "base/time.h"
#include "daemon/loop/histogram.h"

namespace softgrip::daemon {

/// A counter that one thread increases and that any thread may read.
class Counter {
 public:
  void add(std::uint64_t amount = 1) noexcept {
    value_.store(value_.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

/// Statistics of the loop. An overrun (missed cycle) is a period of the schedule in which no tick started.
struct LoopStatistics {
  Histogram wake_up;      ///< time from the scheduled start of a tick to its first instruction
  Histogram compute;      ///< time from the first instruction of a tick to the end of the tick
  Histogram reading_age;  ///< age of the oldest reading at the time when a tick uses it
  Counter ticks;
  Counter overruns_woken_late;  ///< overruns because the thread woke up at least one period late
  Counter overruns_took_long;   ///< overruns because a tick took too long
};

struct BusStatistics {
  Histogram wake_up;
  Histogram exchange;  ///< duration of successful exchanges
  Counter steps;       ///< number of steps of the bus schedule, with or without an exchange
  Counter exchanges;
  Counter failures;
  Counter overruns;
  Counter sessions;                         ///< number of successful connections to the board
  std::atomic<std::uint64_t> attempts{0};   ///< number of attempts to connect since the last successful
                                            ///< exchange
  std::atomic<Nanoseconds> retry_pause{0};  ///< upper limit of the time until the next attempt to connect
};

}  // namespace softgrip::daemon
