#pragma once
// Finds start points for the search for a sustained oscillation.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// An oscillation sine * sin(2 pi f t) + cosine * cos(2 pi f t), where t is the campaign time.
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

/// Number of spectral lines that a search for causes tests.
inline constexpr std::size_t looked_at_lines = 3;

/// Returns the significant lines in the spectrum of the residual over the whole campaign, the most
/// significant first. The significance of a line is its ratio to the neighbouring part of the spectrum.
/// @param residual_mm  one vector per record, as long as the record; NaN for samples without a reading.
[[nodiscard]] std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                               const std::vector<std::vector<double>>& residual_mm,
                                               std::size_t count = looked_at_lines);

}  // namespace softgrip::sysid
