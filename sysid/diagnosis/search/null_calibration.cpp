#include "sysid/diagnosis/search/null_calibration.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {
namespace {

constexpr FitEffort recalibration{.most_iterations = 12, .tolerance = 1e-6};
constexpr std::size_t burn_in = 500;

/// Autoregressive model of the noise, fitted to a residual, and the innovations of this residual.
struct Innovations {
  NoiseModel model;
  std::vector<double> samples_mm;
};

Innovations innovations_of(const std::vector<std::vector<double>>& residual_mm) {
  std::vector<std::span<const double>> series(residual_mm.begin(), residual_mm.end());
  Innovations innovations{fit_noise(autocovariance_of(series)), {}};
  const std::vector<double>& a = innovations.model.coefficients;
  for (const auto& r : residual_mm) {
    for (std::size_t i = a.size(); i < r.size(); ++i) {
      double innovation = r[i];
      for (std::size_t lag = 0; lag < a.size(); ++lag) innovation -= a[lag] * r[i - 1 - lag];
      if (std::isfinite(innovation)) innovations.samples_mm.push_back(innovation);
    }
  }
  if (innovations.samples_mm.empty()) return innovations;
  double mean = 0;
  for (const double e : innovations.samples_mm) mean += e;
  mean /= static_cast<double>(innovations.samples_mm.size());
  for (double& e : innovations.samples_mm) e -= mean;
  return innovations;
}

std::vector<double> drawn_noise(const Innovations& innovations, std::size_t count, std::mt19937_64& random) {
  const std::vector<double>& a = innovations.model.coefficients;
  std::uniform_int_distribution<std::size_t> pick(0, innovations.samples_mm.size() - 1);
  std::vector<double> e(burn_in + count);
  for (std::size_t i = 0; i < e.size(); ++i) {
    e[i] = innovations.samples_mm[pick(random)];
    for (std::size_t lag = 0; lag < std::min(a.size(), i); ++lag) e[i] += a[lag] * e[i - 1 - lag];
  }
  e.erase(e.begin(), e.begin() + static_cast<long>(burn_in));
  return e;
}

/// Returns the records with simulated readings: the prediction of the refitted model plus simulated noise.
std::vector<Record> null_records(const SearchData& data, const StructureFit& recalibrated,
                                 const Innovations& innovations, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Record> records = data.records;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const std::vector<double> noise = drawn_noise(innovations, records[k].size(), random);
    // The prediction is computed as reading minus residual. A sample without a reading has no residual, so
    // its simulated reading is missing too.
    for (std::size_t i = 0; i < records[k].size(); ++i)
      records[k].reading_mm[i] += noise[i] - recalibrated.residual_mm[k][i];
  }
  return records;
}

/// Simulates one campaign without a cause and searches for causes in it. Returns the held-out error reduction
/// by the cause that the search names [%]. Returns 0 if the search names no cause.
double searched_gain_percent(const SearchData& data, const StructureFit& recalibrated,
                             const Innovations& innovations, const Division& division, std::uint64_t seed) {
  SearchData null = make_search_data(null_records(data, recalibrated, innovations, seed), data.given.model);
  null.threads = 1;
  null.scales.has_valve = data.scales.has_valve;
  StructureFit base = fit_structure(null.records, {}, recalibrated.point, recalibration);
  null.scales.residual_lines = spectrum_peaks(null.records, base.residual_mm);
  SelectionOptions options;
  options.seed = seed;
  options.most_causes = 1;  // one cause is sufficient to decide if the search names a cause
  const double noise_mm = measured_noise_mm(null.records);
  const Selection selection = select_causes(null, std::move(base), noise_mm, division, options);
  if (selection.chosen.empty()) return 0;
  return gain_percent(selection.base_losses, selection.extended_losses, seed).value;
}

}  // namespace

NullCalibration calibrate_on_nulls(const SearchData& data, const StructureFit& recalibrated,
                                   double gain_percent, const Division& division,
                                   const NullOptions& options) {
  NullCalibration calibration{.gain_percent = gain_percent};
  const Innovations innovations = innovations_of(recalibrated.residual_mm);
  if (innovations.samples_mm.empty()) return calibration;
  calibration.campaigns = options.campaigns;
  std::vector<double> gains(options.campaigns);
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(options.campaigns, data.threads, [&](std::size_t i) {
    gains[i] = searched_gain_percent(data, recalibrated, innovations, division, options.seed + 1 + i);
    const std::lock_guard lock(mutex);
    if (options.progress) options.progress(++done);
  });
  std::size_t as_large = 0;
  for (const double gain : gains) {
    if (gain > 0) ++calibration.named;
    if (gain >= gain_percent) ++as_large;
    calibration.largest_gain_percent = std::max(calibration.largest_gain_percent, gain);
  }
  calibration.p_value = static_cast<double>(1 + as_large) / static_cast<double>(1 + options.campaigns);
  return calibration;
}

}  // namespace softgrip::sysid
