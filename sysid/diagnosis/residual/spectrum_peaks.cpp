#include "sysid/diagnosis/residual/spectrum_peaks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include <unsupported/Eigen/FFT>

#include "base/statistics.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

using Complex = std::complex<double>;

/// Number of frequency bins on each side of a peak with which the peak is compared, for one record. With
/// several records, the bins are wider and their powers are sums, so fewer bins are used.
constexpr std::size_t widest_around = 60;
/// Number of bins per frequency resolution of the longest record. It is the ratio of the lengths of the
/// transform and of this record. The frequency grid is therefore finer than this resolution.
constexpr std::size_t resolution = 2;
/// Number of lines that are tested as oscillations in a search for causes.
constexpr std::size_t looked_at_lines = 3;
/// Highest frequency of a line, multiplied by time_unit_s(). The samples of a search cannot show a faster
/// oscillation.
constexpr double highest_per_unit = 0.5 / limits::search_interval_in_units;

/// Time grid of the transforms of all records. The first sample of each record is the first point of its
/// grid.
struct Grid {
  double interval_s = 0;
  std::size_t size = 0;
};

Grid grid_of(const std::vector<Record>& records) {
  double longest_s = 0, interval_s = std::numeric_limits<double>::infinity();
  for (const Record& record : records) {
    longest_s = std::max(longest_s, record.length_s());
    interval_s = std::min(interval_s, record.mean_interval_s());
  }
  return {interval_s, std::bit_ceil(resolution * static_cast<std::size_t>(longest_s / interval_s) + 4)};
}

/// Returns a series of a record on the time grid. A sample between two grid points is divided between both
/// points; the nearer point gets the larger part. The accuracy is sufficient for a start value.
/// @param series  one value per sample; NaN for samples without a value.
std::vector<Complex> on_grid(const Grid& grid, const Record& record, const std::vector<double>& series) {
  std::vector<Complex> x(grid.size);
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (std::isnan(series[i])) continue;
    const double place = (record.time_s[i] - record.time_s.front()) / grid.interval_s;
    const auto below = static_cast<std::size_t>(std::max(0.0, place));
    const double share = place - static_cast<double>(below);
    if (below + 1 >= grid.size) continue;
    x[below] += (1 - share) * series[i];
    x[below + 1] += share * series[i];
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

/// Returns the sum of the power spectra.
std::vector<double> power_of(const std::vector<std::vector<Complex>>& spectra) {
  std::vector<double> power(spectra.front().size());
  for (const std::vector<Complex>& spectrum : spectra) {
    for (std::size_t b = 0; b < power.size(); ++b) power[b] += std::norm(spectrum[b]);
  }
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

/// Spectra of the residual and of the drive, up to the highest frequency of a line.
class Spectra {
 public:
  Spectra(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm)
      : records_(records),
        grid_(grid_of(records)),
        around_(std::max(limits::fewest_events / 2, widest_around / records.size())) {
    const double highest_hz = std::min(0.45 / grid_.interval_s, highest_per_unit / time_unit_s(records));
    const std::size_t bins = std::min(grid_.size / 2, static_cast<std::size_t>(highest_hz / step_hz()));
    const auto transformed = [&](const std::vector<std::vector<double>>& series) {
      std::vector<std::vector<Complex>> spectra;
      for (std::size_t k = 0; k < records.size(); ++k)
        spectra.push_back(spectrum_of(on_grid(grid_, records[k], series[k]), bins));
      return spectra;
    };
    residual_ = transformed(residual_mm);
    power_ = power_of(residual_);
    drive_power_ = power_of(transformed(drives_of(records)));
    for (const std::vector<double>& r : residual_mm) readings_ += static_cast<double>(finite_count(r));
  }

  /// A local maximum of the spectrum. `ratio` is the ratio of its power to the median power of its
  /// neighbourhood. A slow model error has no large ratio, because it increases the power of its
  /// neighbourhood too.
  struct Peak {
    double ratio = 0;
    std::size_t bin = 0;
    auto operator<=>(const Peak&) const = default;
  };

  /// Returns the most significant peaks of the residual that are no response to the drive, the largest ratio
  /// first.
  [[nodiscard]] std::vector<Peak> peaks() const {
    std::vector<Peak> all;
    for (std::size_t b = lowest_bin(); b + 1 < power_.size(); ++b) {
      if (power_[b] >= power_[b - 1] && power_[b] >= power_[b + 1]) all.push_back({ratio_at(power_, b), b});
    }
    std::sort(all.rbegin(), all.rend());
    std::vector<Peak> kept;
    for (const Peak& peak : all) {
      if (kept.size() == looked_at_lines) break;
      if (!is_in_drive(peak)) kept.push_back(peak);
    }
    return kept;
  }

  /// Returns the probability that noise alone causes such a peak at any frequency. The power of noise in a
  /// bin, divided by its mean, is the sum of one exponential variable per record.
  [[nodiscard]] double chance_of(const Peak& peak) const {
    const auto count = static_cast<double>(residual_.size());
    // Median of a gamma variable with this shape; for 1 record 0.67 instead of 0.69.
    const double median = count - 1.0 / 3;
    const double sum = peak.ratio * median;
    double term = std::exp(-sum), tail = term;
    for (std::size_t j = 1; j < residual_.size(); ++j) tail += term *= sum / static_cast<double>(j);
    return tail * static_cast<double>(power_.size());
  }

  /// Returns the shift of each record with which the line at the peak has the same phase at the centre of
  /// each record.
  [[nodiscard]] std::vector<double> shifts_for(const Peak& peak) const {
    constexpr double circle = 2 * std::numbers::pi;
    std::vector<double> shifts_s(records_.size(), 0.0);
    for (std::size_t k = 1; k < records_.size(); ++k) {
      const double ahead = std::remainder(phase_at_centre(peak, k) - phase_at_centre(peak, 0), circle);
      shifts_s[k] = centre_s(0) - centre_s(k) + ahead / (circle * frequency_hz(peak));
    }
    return shifts_s;
  }

  /// Returns the lines at the peaks. `shifts_s` contains the shift of each record.
  [[nodiscard]] std::vector<Line> lines(const std::vector<Peak>& peaks,
                                        const std::vector<double>& shifts_s) const {
    std::vector<Line> lines;
    for (const Peak& peak : peaks) lines.push_back(line_at(peak, shifts_s));
    return lines;
  }

 private:
  [[nodiscard]] double frequency_hz(const Peak& peak) const {
    return step_hz() * static_cast<double>(peak.bin);
  }

  /// Returns the time of the centre of a record, from the start of the campaign [s].
  [[nodiscard]] double centre_s(std::size_t record) const {
    const Record& r = records_[record];
    return r.campaign_time_s + 0.5 * (r.time_s.front() + r.time_s.back());
  }

  /// Returns the phase of the residual at the centre of a record, at the frequency of the peak [rad].
  [[nodiscard]] double phase_at_centre(const Peak& peak, std::size_t record) const {
    return std::arg(residual_[record][peak.bin]) + turn(peak, 0.5 * records_[record].length_s());
  }

  [[nodiscard]] Line line_at(const Peak& peak, const std::vector<double>& shifts_s) const {
    // The transform of a record begins at its first sample.
    Complex sum = 0;
    for (std::size_t k = 0; k < residual_.size(); ++k) {
      const Record& r = records_[k];
      const double begin_s = r.campaign_time_s + r.time_s.front() + shifts_s[k];
      sum += residual_[k][peak.bin] * std::polar(1.0, -turn(peak, begin_s));
    }
    const Complex amplitude = 2 / readings_ * sum;
    return {frequency_hz(peak), -amplitude.imag(), amplitude.real()};
  }

  [[nodiscard]] double step_hz() const { return 1 / (grid_.interval_s * static_cast<double>(grid_.size)); }
  [[nodiscard]] double turn(const Peak& peak, double time_s) const {
    return 2 * std::numbers::pi * frequency_hz(peak) * time_s;
  }

  [[nodiscard]] std::size_t lowest_bin() const {
    double campaign_s = 0;
    for (const Record& record : records_) campaign_s += record.length_s();
    return std::max(resolution,
                    static_cast<std::size_t>(std::ceil(slowest_oscillation_hz(campaign_s) / step_hz())));
  }

  /// Returns the ratio of the power in a bin to the median power of its neighbourhood.
  [[nodiscard]] double ratio_at(const std::vector<double>& power, std::size_t bin) const {
    const std::size_t first = bin > around_ ? bin - around_ : 1;
    const std::size_t last = std::min(power.size(), bin + around_);
    std::vector<double> near(power.begin() + static_cast<long>(first),
                             power.begin() + static_cast<long>(last));
    return power[bin] / (median_of(std::span(near)) + 1e-300);
  }

  /// Returns true if the drive has a line at this frequency whose ratio is at least half of that of the peak.
  /// The residual may then be a response to the drive.
  [[nodiscard]] bool is_in_drive(const Peak& peak) const {
    const std::size_t last = std::min(peak.bin + resolution, drive_power_.size() - 1);
    for (std::size_t b = peak.bin - resolution; b <= last; ++b) {
      if (ratio_at(drive_power_, b) >= limits::majority_share * peak.ratio) return true;
    }
    return false;
  }

  const std::vector<Record>& records_;
  Grid grid_;
  std::size_t around_;
  std::vector<std::vector<Complex>> residual_;  ///< one spectrum per record
  std::vector<double> power_, drive_power_;
  double readings_ = 0;
};

}  // namespace

std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm) {
  const Spectra spectra(records, residual_mm);
  std::vector<double> shifts_s;
  for (const Record& record : records) shifts_s.push_back(record.oscillation_shift_s);
  return spectra.lines(spectra.peaks(), shifts_s);
}

AlignedLines aligned_lines(const std::vector<Record>& records,
                           const std::vector<std::vector<double>>& residual_mm) {
  const Spectra spectra(records, residual_mm);
  const std::vector<Spectra::Peak> peaks = spectra.peaks();
  AlignedLines aligned{{}, std::vector<double>(records.size(), 0.0)};
  if (records.size() > 1 && !peaks.empty() &&
      spectra.chance_of(peaks.front()) < 1 - limits::strict_probability)
    aligned.shifts_s = spectra.shifts_for(peaks.front());
  aligned.lines = spectra.lines(peaks, aligned.shifts_s);
  return aligned;
}

void set_oscillation_shifts(std::vector<Record>& records, const std::vector<double>& shifts_s) {
  for (std::size_t k = 0; k < records.size(); ++k) records[k].oscillation_shift_s = shifts_s[k];
}

}  // namespace softgrip::sysid
