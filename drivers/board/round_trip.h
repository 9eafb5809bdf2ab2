#pragma once
// Measures the round trip of a request. Calculates the duration of an exchange from the measured round trips.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "drivers/board/board.h"

namespace softgrip::drivers {

/// The durations of the first round trips (at most 32) after the session was opened.
class RoundTrip {
 public:
  void reset() noexcept { count_ = 0; }
  void add(Nanoseconds duration) noexcept {
    if (count_ < durations_.size()) durations_[count_++] = duration;
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// median_s() returns the median, and slowest_s() the longest duration [s]; both return 0 without a
  /// measurement.
  [[nodiscard]] double median_s() const noexcept;
  [[nodiscard]] double slowest_s() const noexcept;

 private:
  std::array<Nanoseconds, 32> durations_{};
  std::size_t count_ = 0;
};

/// Returns the duration of `transactions` consecutive round trips, and an explanation of the calculation. The
/// calculation uses the measured median, because other load of this machine may delay single round trips. The
/// explanation also gives the longest round trip. Without a measurement, the calculation uses an assumed
/// round trip, and the explanation says this.
[[nodiscard]] Board::Budget tcp_cost(std::size_t transactions, const std::string& plan,
                                     const std::string& host, const RoundTrip& measured);

/// Returns a duration as text in milliseconds, for example "9.7 ms".
[[nodiscard]] std::string milliseconds(double seconds);

/// Returns the duration of an exchange over several links that are used one after the other. The explanation
/// combines the explanations of the links and gives the highest possible rate.
[[nodiscard]] Board::Budget sum_of(std::span<const Board::Budget> costs);

}  // namespace softgrip::drivers
