#pragma once
// Finds the strongest lines in the spectrum of a residual. The search for a sustained oscillation starts its
// fits at these lines.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// An oscillation sine * sin(2 pi f t) + cosine * cos(2 pi f t). The time t begins at the start of the
/// campaign.
struct Line {
  double frequency_hz = 0;
  double sine_mm = 0;
  double cosine_mm = 0;
};

/// Returns the lowest frequency that counts as an oscillation in a campaign of this length [Hz]. A slower
/// variation counts as a drift of the zero offset.
[[nodiscard]] inline double slowest_oscillation_hz(double campaign_s) {
  return std::max(0.2, 10 / std::max(campaign_s, 1.0));
}

/// Number of spectral lines that a search for causes tests as oscillations.
inline constexpr std::size_t looked_at_lines = 3;

/// Returns the significant lines in the spectrum of the residual of the whole campaign. The most significant
/// line comes first. The significance of a line is the ratio of its power to the median power of the
/// neighbouring frequencies.
/// @param residual_mm  one vector per record, as long as the record; NaN for samples without a reading.
[[nodiscard]] std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                               const std::vector<std::vector<double>>& residual_mm,
                                               std::size_t count = looked_at_lines);

}  // namespace softgrip::sysid
