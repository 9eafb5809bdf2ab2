#pragma once
// Where a search for a steady oscillation begins.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// An oscillation sine sin(2 pi f t) + cosine cos(2 pi f t), t in campaign time.
struct Line {
  double frequency_hz = 0;
  double sine_mm = 0;
  double cosine_mm = 0;
};

/// What is slower than this in a campaign of such a length is a wandering zero and no oscillation [Hz].
[[nodiscard]] inline double slowest_oscillation_hz(double campaign_s) {
  return std::max(0.2, 10 / std::max(campaign_s, 1.0));
}

/// So many a search for causes looks at.
inline constexpr std::size_t looked_at_lines = 3;

/// The lines that stand out against their neighbourhood in the residual's spectrum over the whole campaign,
/// the clearest first.
/// @param residual_mm  by record, as long as the record; NaN where there is no reading.
[[nodiscard]] std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                               const std::vector<std::vector<double>>& residual_mm,
                                               std::size_t count = looked_at_lines);

}  // namespace softgrip::sysid
