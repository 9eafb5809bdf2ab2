#include "sysid/diagnosis/residual/spectrum_peaks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include <unsupported/Eigen/FFT>

#include "base/statistics.h"

namespace softgrip::sysid {
namespace {

using Complex = std::complex<double>;

/// Number of frequency bins on each side of a peak with which the peak is compared.
constexpr std::size_t around = 60;
constexpr double highest_looked_at_hz = 25;

/// Returns the residuals of all records on one common time grid over the campaign. A sample between two grid
/// points is divided between both points; the nearer point gets the larger part. The accuracy is sufficient
/// for a start value.
std::vector<Complex> on_one_grid(const std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double interval_s,
                                 std::size_t size) {
  std::vector<Complex> x(size);
  const double began_s = records.front().campaign_time_s + records.front().time_s.front();
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); ++i) {
      if (std::isnan(residual_mm[k][i])) continue;
      const double place = (records[k].campaign_time_s + records[k].time_s[i] - began_s) / interval_s;
      const auto below = static_cast<std::size_t>(std::max(0.0, place));
      const double share = place - static_cast<double>(below);
      if (below + 1 >= size) continue;
      x[below] += (1 - share) * residual_mm[k][i];
      x[below + 1] += share * residual_mm[k][i];
    }
  }
  return x;
}

/// Returns two numbers for each local maximum of the spectrum: the ratio of its power to the median power of
/// its neighbourhood, and its bin. The list is sorted by the ratio, the largest first. A slow model error has
/// no large ratio, because it increases the power of its neighbourhood too.
std::vector<std::pair<double, std::size_t>> peaks_of(const std::vector<double>& power, std::size_t lowest) {
  std::vector<std::pair<double, std::size_t>> peaks;
  std::vector<double> near;
  for (std::size_t b = std::max<std::size_t>(2, lowest); b + 1 < power.size(); ++b) {
    if (power[b] < power[b - 1] || power[b] < power[b + 1]) continue;
    const std::size_t first = b > around ? b - around : 1;
    const std::size_t last = std::min(power.size(), b + around);
    near.assign(power.begin() + static_cast<long>(first), power.begin() + static_cast<long>(last));
    peaks.emplace_back(power[b] / (median_of(std::span(near)) + 1e-300), b);
  }
  std::sort(peaks.rbegin(), peaks.rend());
  return peaks;
}

}  // namespace

std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, std::size_t count) {
  double length_s = 0, interval_s = std::numeric_limits<double>::infinity();
  for (const Record& record : records) {
    length_s += record.length_s();
    interval_s = std::min(interval_s, record.mean_interval_s());
  }
  const double campaign_s = records.back().campaign_time_s + records.back().time_s.back() -
                            records.front().campaign_time_s - records.front().time_s.front();
  // The transform is twice as long as the campaign. The frequency grid is therefore finer than the frequency
  // resolution of the campaign.
  const std::size_t size = std::bit_ceil(2 * static_cast<std::size_t>(campaign_s / interval_s) + 4);
  std::vector<Complex> x = on_one_grid(records, residual_mm, interval_s, size);
  std::vector<Complex> transformed;
  Eigen::FFT<double>().fwd(transformed, x);
  const double step_hz = 1 / (interval_s * static_cast<double>(size));
  const double highest_hz = std::min(0.45 / interval_s, highest_looked_at_hz);
  const double lowest_hz = slowest_oscillation_hz(length_s);
  std::vector<double> power(std::min(size / 2, static_cast<std::size_t>(highest_hz / step_hz)));
  for (std::size_t b = 0; b < power.size(); ++b) power[b] = std::norm(transformed[b]);
  const auto peaks = peaks_of(power, static_cast<std::size_t>(std::ceil(lowest_hz / step_hz)));
  double readings = 0;
  for (const auto& r : residual_mm) {
    for (const double value : r) readings += std::isnan(value) ? 0 : 1;
  }
  const double began_s = records.front().campaign_time_s + records.front().time_s.front();
  std::vector<Line> lines;
  for (std::size_t i = 0; i < std::min(count, peaks.size()); ++i) {
    const double frequency_hz = step_hz * static_cast<double>(peaks[i].second);
    // The phase is corrected for different time origins. The transform begins at the first sample, and the
    // oscillation is defined from the start of the campaign.
    const Complex amplitude = 2 / readings * transformed[peaks[i].second] *
                              std::polar(1.0, -2 * std::numbers::pi * frequency_hz * began_s);
    lines.push_back({frequency_hz, -amplitude.imag(), amplitude.real()});
  }
  return lines;
}

}  // namespace softgrip::sysid
