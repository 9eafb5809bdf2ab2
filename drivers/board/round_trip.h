#pragma once
// Measures the round trip of a request, and calculates the duration of an exchange from it.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "drivers/board/board.h"

namespace softgrip::drivers {

/// Round trips measured when the session was opened. The first ones are kept.
class RoundTrip {
 public:
  void reset() noexcept { count_ = 0; }
  void add(Nanoseconds duration) noexcept {
    if (count_ < durations_.size()) durations_[count_++] = duration;
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// The next two functions return 0 without a measurement.
  [[nodiscard]] double median_s() const noexcept;
  [[nodiscard]] double slowest_s() const noexcept;

 private:
  std::array<Nanoseconds, 32> durations_{};
  std::size_t count_ = 0;
};

/// Returns the duration of `transactions` consecutive round trips. It uses the measured median, because a
/// single round trip may be delayed by other load of this machine; the text also states the slowest one.
/// Without a measurement it uses an assumed round trip, and the text states this.
[[nodiscard]] Board::Budget tcp_cost(std::size_t transactions, const std::string& plan,
                                     const std::string& host, const RoundTrip& measured);

/// Returns, for example, "9.7 ms".
[[nodiscard]] std::string milliseconds(double seconds);

/// Returns the sum of the costs of links that are used one after the other, with their texts and the possible
/// rate.
[[nodiscard]] Board::Budget sum_of(std::span<const Board::Budget> costs);

}  // namespace softgrip::drivers
