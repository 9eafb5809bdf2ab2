#pragma once
// Measures the round trips of requests, and calculates the duration of an exchange from the measurements.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "drivers/board/board.h"

namespace softgrip::drivers {

/// Stores the durations of the first round trips after a session was opened, at most 32.
class RoundTrip {
 public:
  void reset() noexcept { count_ = 0; }
  void add(Nanoseconds duration) noexcept {
    if (count_ < durations_.size()) durations_[count_++] = duration;
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// median_s() returns the median of the stored durations [s]. slowest_s() returns the longest stored
  /// duration [s]. Both return 0 if no duration is stored.
  [[nodiscard]] double median_s() const noexcept;
  [[nodiscard]] double slowest_s() const noexcept;

 private:
  std::array<Nanoseconds, 32> durations_{};
  std::size_t count_ = 0;
};

/// Returns the duration of `transactions` consecutive round trips, and an explanation of the calculation. The
/// calculation uses the measured median, because other programs on this machine may delay single round trips.
/// The explanation also gives the longest round trip. Without a measurement, the calculation uses an assumed
/// round trip, and the explanation states this assumption.
[[nodiscard]] Board::Budget tcp_cost(std::size_t transactions, const std::string& plan,
                                     const std::string& host, const RoundTrip& measured);

/// Returns a duration as text in milliseconds, for example "9.7 ms".
[[nodiscard]] std::string milliseconds(double seconds);

/// Returns the duration of an exchange that uses several links one after the other. The explanation combines
/// the explanations of the links and gives the highest possible rate.
[[nodiscard]] Board::Budget sum_of(std::span<const Board::Budget> costs);

}  // namespace softgrip::drivers
