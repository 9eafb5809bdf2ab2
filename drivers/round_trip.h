#pragma once
// How long one question and its answer take, and what that makes of an exchange.

#include <cstddef>
#include <string>

#include "drivers/board.h"

namespace softgrip::drivers {

/// Round trips measured when the session was opened.
class RoundTrip {
 public:
  void reset() noexcept { *this = RoundTrip(); }
  void add(Nanoseconds duration) noexcept {
    ++count_;
    if (duration > slowest_) slowest_ = duration;
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// 0 without a measurement.
  [[nodiscard]] double slowest_s() const noexcept { return static_cast<double>(slowest_) * 1e-9; }

 private:
  std::size_t count_ = 0;
  Nanoseconds slowest_ = 0;
};

/// The budget of an exchange of `transactions` round trips, one after the other, at the slowest that was
/// measured; without a measurement at an assumed one, and the text says that it is assumed.
[[nodiscard]] Board::Budget tcp_budget(std::size_t transactions, const std::string& plan,
                                       const std::string& host, const RoundTrip& measured);

}  // namespace softgrip::drivers
