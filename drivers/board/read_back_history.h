#pragma once
// Whether what a board says of its outputs is something it was told, now or a little earlier.

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "drivers/board/board_map.h"

namespace softgrip::drivers {

/// The raw numbers written in the last exchanges of a session, as many as the board's read-back may lag.
/// Allocates when made, never later.
class ReadBackHistory {
 public:
  ReadBackHistory(const ReadBack& rules, std::size_t channels)
      : tolerance_(rules.tolerance_raw),
        depth_(rules.lag_exchanges + std::size_t{1}),
        channels_(channels),
        written_(depth_ * channels) {}

  /// A new session: what was written before it is unknown.
  void forget() noexcept { exchanges_ = 0; }

  /// One exchange wrote these, one per channel.
  void note(std::span<const double> raws) noexcept {
    const std::size_t at = exchanges_++ % depth_ * channels_;
    for (std::size_t i = 0; i < channels_; ++i) written_[at + i] = raws[i];
  }

  /// True if `raw` is near one of the numbers that the board may show now. Until as many exchanges were
  /// noted as it may lag, it may still show something from before. NaN is never accepted.
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
