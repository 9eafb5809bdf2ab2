#include "sysid/diagnosis/residual/spectrum_peaks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include <unsupported/Eigen/FFT>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

using Complex = std::complex<double>;

/// Number of frequency bins on each side of a peak with which the peak is compared.
constexpr std::size_t around = 60;
/// Number of bins per frequency resolution of the campaign. It is the ratio of the lengths of the transform
/// and of the campaign. The frequency grid is therefore finer than this resolution.
constexpr std::size_t resolution = 2;
/// Number of lines that are tested as oscillations in a search for causes.
constexpr std::size_t looked_at_lines = 3;
/// Highest frequency of a line. The samples of a search (limits::search_interval_s) cannot show a faster
/// oscillation.
constexpr double highest_looked_at_hz = 0.5 / limits::search_interval_s;

/// Common time grid of a campaign.
struct Grid {
  double began_s = 0, interval_s = 0;
  std::size_t size = 0;
};

/// Returns a series of all records on the common time grid. A sample between two grid points is divided
/// between both points; the nearer point gets the larger part. The accuracy is sufficient for a start value.
/// @param series  one vector per record; NaN for samples without a value.
std::vector<Complex> on_grid(const Grid& grid, const std::vector<Record>& records,
                             const std::vector<std::vector<double>>& series) {
  std::vector<Complex> x(grid.size);
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); ++i) {
      if (std::isnan(series[k][i])) continue;
      const double place =
          (records[k].campaign_time_s + records[k].time_s[i] - grid.began_s) / grid.interval_s;
      const auto below = static_cast<std::size_t>(std::max(0.0, place));
      const double share = place - static_cast<double>(below);
      if (below + 1 >= grid.size) continue;
      x[below] += (1 - share) * series[k][i];
      x[below + 1] += share * series[k][i];
    }
  }
  return x;
}

/// Returns the spectrum of a series up to the given number of bins.
std::vector<Complex> spectrum_of(std::vector<Complex> x, std::size_t bins) {
  std::vector<Complex> transformed;
  Eigen::FFT<double>().fwd(transformed, x);
  transformed.resize(bins);
  return transformed;
}

std::vector<double> power_of(const std::vector<Complex>& spectrum) {
  std::vector<double> power;
  for (const Complex& each : spectrum) power.push_back(std::norm(each));
  return power;
}

/// Returns the drives of all records minus their mean.
std::vector<std::vector<double>> drives_of(const std::vector<Record>& records) {
  std::vector<std::vector<double>> drives;
  double sum = 0, count = 0;
  for (const Record& record : records) {
    drives.push_back(record.drive_kpa);
    sum = std::accumulate(record.drive_kpa.begin(), record.drive_kpa.end(), sum);
    count += static_cast<double>(record.size());
  }
  for (std::vector<double>& drive : drives) {
    for (double& kpa : drive) kpa -= sum / std::max(1.0, count);
  }
  return drives;
}

/// Returns the ratio of the power in a bin to the median power of its neighbourhood.
double ratio_at(const std::vector<double>& power, std::size_t bin) {
  const std::size_t first = bin > around ? bin - around : 1;
  const std::size_t last = std::min(power.size(), bin + around);
  std::vector<double> near(power.begin() + static_cast<long>(first), power.begin() + static_cast<long>(last));
  return power[bin] / (median_of(std::span(near)) + 1e-300);
}

/// Returns true if the drive has a line at this frequency whose ratio is at least half of `ratio`. The
/// residual may then be a response to the drive.
bool is_in_drive(const std::vector<double>& drive_power, std::size_t bin, double ratio) {
  for (std::size_t b = bin - resolution; b <= std::min(bin + resolution, drive_power.size() - 1); ++b) {
    if (ratio_at(drive_power, b) >= limits::majority_share * ratio) return true;
  }
  return false;
}

/// Returns two numbers for each local maximum of the spectrum: the ratio of its power to the median power of
/// its neighbourhood, and its bin. The list is sorted by the ratio, the largest first. A slow model error has
/// no large ratio, because it increases the power of its neighbourhood too.
std::vector<std::pair<double, std::size_t>> peaks_of(const std::vector<double>& power, std::size_t lowest) {
  std::vector<std::pair<double, std::size_t>> peaks;
  for (std::size_t b = std::max(resolution, lowest); b + 1 < power.size(); ++b) {
    if (power[b] >= power[b - 1] && power[b] >= power[b + 1]) peaks.emplace_back(ratio_at(power, b), b);
  }
  std::sort(peaks.rbegin(), peaks.rend());
  return peaks;
}

}  // namespace

std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm) {
  double length_s = 0, interval_s = std::numeric_limits<double>::infinity();
  for (const Record& record : records) {
    length_s += record.length_s();
    interval_s = std::min(interval_s, record.mean_interval_s());
  }
  const double campaign_s = records.back().campaign_time_s + records.back().time_s.back() -
                            records.front().campaign_time_s - records.front().time_s.front();
  const Grid grid{records.front().campaign_time_s + records.front().time_s.front(), interval_s,
                  std::bit_ceil(resolution * static_cast<std::size_t>(campaign_s / interval_s) + 4)};
  const double step_hz = 1 / (interval_s * static_cast<double>(grid.size));
  const double highest_hz = std::min(0.45 / interval_s, highest_looked_at_hz);
  const double lowest_hz = slowest_oscillation_hz(length_s);
  const std::size_t bins = std::min(grid.size / 2, static_cast<std::size_t>(highest_hz / step_hz));
  const std::vector<Complex> transformed = spectrum_of(on_grid(grid, records, residual_mm), bins);
  const std::vector<double> drive_power =
      power_of(spectrum_of(on_grid(grid, records, drives_of(records)), bins));
  const auto peaks =
      peaks_of(power_of(transformed), static_cast<std::size_t>(std::ceil(lowest_hz / step_hz)));
  double readings = 0;
  for (const auto& r : residual_mm) {
    for (const double value : r) readings += std::isnan(value) ? 0 : 1;
  }
  std::vector<Line> lines;
  for (const auto& [ratio, bin] : peaks) {
    if (lines.size() == looked_at_lines) break;
    if (is_in_drive(drive_power, bin, ratio)) continue;
    const double frequency_hz = step_hz * static_cast<double>(bin);
    // The phase is corrected for different time origins. The transform begins at the first sample, and the
    // oscillation is defined from the start of the campaign.
    const Complex amplitude = 2 / readings * transformed[bin] *
                              std::polar(1.0, -2 * std::numbers::pi * frequency_hz * grid.began_s);
    lines.push_back({frequency_hz, -amplitude.imag(), amplitude.real()});
  }
  return lines;
}

}  // namespace softgrip::sysid
