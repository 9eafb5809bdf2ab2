#pragma once
// How long one question and its answer take, and what that makes of an exchange.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "drivers/board/board.h"

namespace softgrip::drivers {

/// Round trips measured when the session was opened; the first few are kept.
class RoundTrip {
 public:
  void reset() noexcept { count_ = 0; }
  void add(Nanoseconds duration) noexcept {
    if (count_ < durations_.size()) durations_[count_++] = duration;
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Both 0 without a measurement.
  [[nodiscard]] double median_s() const noexcept;
  [[nodiscard]] double slowest_s() const noexcept;

 private:
  std::array<Nanoseconds, 32> durations_{};
  std::size_t count_ = 0;
};

/// What `transactions` round trips take, one after the other, at the median that was measured (one of few may
/// have met a busy moment of this machine; the slowest is told besides); without a measurement at an assumed
/// one, and the text says that it is assumed.
[[nodiscard]] Board::Budget tcp_cost(std::size_t transactions, const std::string& plan,
                                     const std::string& host, const RoundTrip& measured);

/// "9.7 ms"
[[nodiscard]] std::string milliseconds(double seconds);

/// Costs of links that are used one after the other: their sum, their texts, and the rate they allow.
[[nodiscard]] Board::Budget sum_of(std::span<const Board::Budget> costs);

}  // namespace softgrip::drivers
