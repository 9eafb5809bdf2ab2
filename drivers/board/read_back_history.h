#pragma once
// Compares the outputs that a board reports with the outputs that the last exchanges wrote.

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "drivers/board/board_map.h"

namespace softgrip::drivers {

/// The raw numbers of the last exchanges of a session. It stores the present exchange and as many earlier
/// ones as the board's read-back may lag. Only the constructor allocates.
class ReadBackHistory {
 public:
  ReadBackHistory(const ReadBack& rules, std::size_t channels)
      : tolerance_(rules.tolerance_raw),
        depth_(rules.lag_exchanges + std::size_t{1}),
        channels_(channels),
        written_(depth_ * channels) {}

  /// Begins a new session and discards the stored numbers.
  void forget() noexcept { exchanges_ = 0; }

  /// Stores the raw numbers that one exchange wrote, one per channel.
  void note(std::span<const double> raws) noexcept {
    const std::size_t at = exchanges_++ % depth_ * channels_;
    for (std::size_t i = 0; i < channels_; ++i) written_[at + i] = raws[i];
  }

  /// Returns true if `raw` is within the tolerance of a stored number. At the beginning of a session the
  /// board may still report numbers of the last session, so all numbers are accepted. NaN is never accepted.
  [[nodiscard]] bool accepts(std::size_t channel, double raw) const noexcept {
    if (exchanges_ < depth_) return !std::isnan(raw);
    for (std::size_t i = 0; i < depth_; ++i) {
      if (std::abs(raw - written_[i * channels_ + channel]) <= tolerance_) return true;
    }
    return false;
  }

 private:
  double tolerance_;
  std::size_t depth_;
  std::size_t channels_;
  std::vector<double> written_;
  std::size_t exchanges_ = 0;
};

}  // namespace softgrip::drivers
