#include "sysid/diagnosis/evidence/evidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <unsupported/Eigen/FFT>

#include "base/statistics.h"

namespace softgrip::sysid {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t shown = 100;
/// Width of the two frequency ranges with which a spectral line is compared, below and above the line
/// [frequency bins]. The width of a bin is the frequency resolution of one record.
constexpr std::size_t around = 40;
/// Half of the width of the main lobe of a Hann window, plus a margin [frequency bins].
constexpr std::size_t lobe = 3;

/// Sum of |FFT(window * residual)|^2 over the records, for each frequency of a common grid.
struct Periodogram {
  double step_hz = 0;
  double window_squares = 0;      ///< sum of the squared windows of all records
  double window_mean_square = 0;  ///< sum over all records; the term of a record is the square of the sum of
                                  ///< its window values
  double interval_s = 0;
  std::size_t longest = 0;
  std::vector<double> power;
};

Periodogram periodogram(const std::vector<Record>& records,
                        const std::vector<std::vector<double>>& residual_mm) {
  Periodogram p;
  for (const Record& record : records) {
    p.longest = std::max(p.longest, record.size());
    p.interval_s = std::max(p.interval_s, record.mean_interval_s());
  }
  const std::size_t size = std::bit_ceil(p.longest);
  p.step_hz = 1 / (p.interval_s * static_cast<double>(size));
  p.power.assign(size / 2, 0.0);
  std::vector<Complex> x(size), transformed;
  Eigen::FFT<double> fourier;
  for (const std::vector<double>& r : residual_mm) {
    double mean = 0, count = 0;
    for (const double v : r) {
      if (!std::isfinite(v)) continue;
      mean += v;
      count += 1;
    }
    if (count < 64) continue;
    mean /= count;
    double window_sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
      x[i] = 0;
      if (i >= r.size() || !std::isfinite(r[i])) continue;
      const double w =
          square(std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(r.size())));
      x[i] = w * (r[i] - mean);
      window_sum += w;
      p.window_squares += w * w;
    }
    p.window_mean_square += square(window_sum);
    fourier.fwd(transformed, x);
    for (std::size_t b = 0; b < p.power.size(); ++b) p.power[b] += std::norm(transformed[b]);
  }
  return p;
}

void add_curve(const Periodogram& p, SpectrumEvidence& evidence) {
  const double to_density = 2 * p.interval_s / p.window_squares;
  const double ratio = std::pow(static_cast<double>(p.power.size()), 1.0 / shown);
  for (double edge = 1; edge < static_cast<double>(p.power.size());) {
    const double next = std::max(edge + 1, edge * ratio);
    double sum = 0, count = 0, place = 0;
    for (auto b = static_cast<std::size_t>(edge);
         b < std::min(p.power.size(), static_cast<std::size_t>(next)); ++b) {
      sum += p.power[b];
      place += static_cast<double>(b);
      count += 1;
    }
    if (count > 0) {
      evidence.frequency_hz.push_back(p.step_hz * place / count);
      evidence.density_mm2_per_hz.push_back(to_density * sum / count);
    }
    edge = next;
  }
}

/// Returns the level of the spectrum near the bin b. The main lobe of the line in this bin is excluded. The
/// spectrum of a model error is steep. Therefore the level is the larger one of two medians, below and above
/// the line. Returns 0 if there are not enough bins below the line.
double level_around(const Periodogram& p, std::size_t b, std::size_t padding) {
  const std::size_t reach = around * padding, width = lobe * padding;
  std::vector<double> low, high;
  for (std::size_t k = b > reach ? b - reach : 1; k + width < b; ++k) low.push_back(p.power[k]);
  for (std::size_t k = b + width + 1; k < std::min(p.power.size(), b + reach + 1); ++k)
    high.push_back(p.power[k]);
  const std::size_t fewest = around * padding / 4;
  if (low.size() < fewest) return 0;
  const double below = median_of(std::span(low));
  return high.size() < fewest ? below : std::max(below, median_of(std::span(high)));
}

/// Returns true if the command has a line at this frequency. The response to such a command has a line at the
/// same frequency, which is not a disturbance.
bool driven(const Periodogram& drive, std::size_t b, std::size_t padding) {
  constexpr double stands_out = 10;
  const std::size_t width = lobe * padding;
  double highest = 0;
  for (std::size_t k = b > width ? b - width : 1; k < std::min(drive.power.size(), b + width + 1); ++k)
    highest = std::max(highest, drive.power[k]);
  return highest > stands_out * level_around(drive, b, padding);
}

void find_line(const Periodogram& p, const Periodogram& drive, double structural_mm2,
               SpectrumEvidence& evidence) {
  // Zero padding makes the frequency grid finer than the resolution of the window.
  const std::size_t padding = std::max<std::size_t>(1, 2 * p.power.size() / p.longest);
  double strongest = 0, background = 0;
  std::size_t at = 0;
  for (std::size_t b = 2; b + 1 < p.power.size(); ++b) {
    if (p.power[b] < p.power[b - 1] || p.power[b] < p.power[b + 1]) continue;
    const double level = level_around(p, b, padding);
    if (level == 0 || p.power[b] <= strongest * level || driven(drive, b, padding)) continue;
    strongest = p.power[b] / level;
    background = level;
    at = b;
  }
  if (at == 0) return;
  evidence.peak_hz = p.step_hz * static_cast<double>(at);
  const double amplitude2 = 4 * std::max(0.0, p.power[at] - background) / p.window_mean_square;
  evidence.peak_amplitude_mm = std::sqrt(amplitude2);
  const auto lines = static_cast<double>(p.power.size()) / static_cast<double>(padding);
  // For one record of noise, the ratio of the power in a bin to the mean level has an exponential
  // distribution. For several records, large ratios are less likely. The p-value is therefore an upper bound.
  evidence.p_value = std::min(1.0, lines * std::exp(-strongest * std::numbers::ln2));
  if (structural_mm2 > 0)
    evidence.share_percent = std::clamp(100 * amplitude2 / 2 / structural_mm2, 0.0, 100.0);
}

}  // namespace

SpectrumEvidence spectrum_of(const std::vector<Record>& records,
                             const std::vector<std::vector<double>>& residual_mm, double structural_mm2) {
  SpectrumEvidence evidence;
  for (const Record& record : records) {
    if (record.sample_time_s == 0) evidence.why_not = "sampled irregularly";
    if (record.size() < 128) evidence.why_not = "a log is too short";
  }
  if (!evidence.why_not.empty()) return evidence;
  const Periodogram p = periodogram(records, residual_mm);
  if (p.window_squares == 0) {
    evidence.why_not = "too few readings";
    return evidence;
  }
  add_curve(p, evidence);
  std::vector<std::vector<double>> drive;
  drive.reserve(records.size());
  for (const Record& record : records) drive.push_back(record.drive_kpa);
  find_line(p, periodogram(records, drive), structural_mm2, evidence);
  return evidence;
}

}  // namespace softgrip::sysid
