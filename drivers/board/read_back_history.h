#pragma once
// Compares the outputs that a board reports with the outputs that were written in the last exchanges.

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "drivers/board/board_map.h"

namespace softgrip::drivers {

/// Stores the raw numbers that the last exchanges of a session wrote. The number of stored exchanges is one
/// more than the number of exchanges by which the board's read-back may lag. Only the constructor allocates
/// memory.
class ReadBackHistory {
 public:
  ReadBackHistory(const ReadBack& rules, std::size_t channels)
      : tolerance_(rules.tolerance_raw),
        depth_(rules.lag_exchanges + std::size_t{1}),
        channels_(channels),
        written_(depth_ * channels) {}

  /// Discards the stored numbers. The caller calls this function at the start of a new session.
  void forget() noexcept { exchanges_ = 0; }

  /// Stores the raw numbers that one exchange has written, one per channel.
  void note(std::span<const double> raws) noexcept {
    const std::size_t at = exchanges_++ % depth_ * channels_;
    for (std::size_t i = 0; i < channels_; ++i) written_[at + i] = raws[i];
  }

  /// Returns true if `raw` differs from one of the channel's stored numbers by at most the tolerance. At the
  /// start of a session, every number except NaN is accepted, because the board may still report numbers of
  /// the last session. NaN is never accepted.
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
