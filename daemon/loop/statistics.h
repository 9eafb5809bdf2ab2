#pragma once
// Statistics of the loop and the bus, which are always recorded. Loop and bus write them, and any thread may
// read them. One thread adds durations to a histogram, and any thread may read the histogram.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.h"

namespace softgrip::daemon {

/// Counts durations in bins. Durations are in nanoseconds. Below 128 ns, a bin is 1 ns wide. Above 128 ns, a
/// bin is as wide as 1/128 of the start of its octave, so the error is below 0.8 % for durations up to 68 s.
/// The bins need 30 kB. A negative duration is added to the bin of 0, and a duration above 68 s to the last
/// bin. add() needs a few plain loads and stores, no locks and no atomic additions.
class Histogram {
 public:
  /// Adds a duration to the histogram. One thread may call this function, and always the same one.
  void add(std::int64_t duration_ns) noexcept;

  /// Summary of all durations in the histogram. If add() runs during the call of summary(), the newest
  /// durations may be missing.
  struct Summary {
    std::uint64_t count = 0;
    std::int64_t min_ns = 0;
    std::int64_t max_ns = 0;
    double mean_ns = 0;
    std::int64_t p50_ns = 0;
    std::int64_t p99_ns = 0;
    std::int64_t p999_ns = 0;
  };
  [[nodiscard]] Summary summary() const;

  /// Returns the upper end of the bin that contains the quantile q (0 to 1), but at most the largest
  /// duration; 0 if there are no durations.
  [[nodiscard]] std::int64_t quantile_ns(double q) const;

  /// Returns the lower end [ns] and the number of durations of each bin that is not empty.
  struct Bin {
    std::int64_t lower_ns;
    std::uint64_t count;
  };
  [[nodiscard]] std::vector<Bin> bins() const;

  /// Returns the histogram in the form of `cyclictest --histogram`: one line per microsecond with the number
  /// of durations, then minimum, average and maximum. Above 131 us, a bin is wider than 1 us. Such a bin is
  /// listed at its lower end.
  [[nodiscard]] std::string cyclictest_text(std::string_view title) const;

 private:
  static constexpr int sub_bits = 7;
  static constexpr std::size_t sub_count = std::size_t{1} << sub_bits;
  static constexpr int top_bit = 36;  // the histogram covers durations below 2^36 ns
  static constexpr std::size_t bin_count = sub_count * (top_bit - sub_bits + 1);

  [[nodiscard]] static std::size_t index_of(std::uint64_t duration_ns) noexcept;
  [[nodiscard]] static std::int64_t lower_of(std::size_t index) noexcept;

  std::array<std::atomic<std::uint64_t>, bin_count> bins_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::uint64_t> sum_ns_{0};
  std::atomic<std::int64_t> min_ns_{0};
  std::atomic<std::int64_t> max_ns_{0};
};

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
