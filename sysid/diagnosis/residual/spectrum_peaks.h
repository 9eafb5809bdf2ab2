#pragma once
// Finds the start points of a search for a steady oscillation.

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

/// Returns the lowest frequency of an oscillation [Hz] in a campaign of this length. A slower variation is a
/// drift of the zero.
[[nodiscard]] inline double slowest_oscillation_hz(double campaign_s) {
  return std::max(0.2, 10 / std::max(campaign_s, 1.0));
}

/// Number of lines that a search for causes tests.
inline constexpr std::size_t looked_at_lines = 3;

/// Returns the significant lines in the spectrum of the residual over the whole campaign, most significant
/// first. Each is compared with its neighbourhood.
/// @param residual_mm  by record, as long as the record; NaN where there is no reading.
[[nodiscard]] std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                               const std::vector<std::vector<double>>& residual_mm,
                                               std::size_t count = looked_at_lines);

}  // namespace softgrip::sysid
