#include "sysid/diagnosis/search/stick_slip.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/jump_tracking.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Ratio of one trial value of the band to the next smaller one. The tracker tolerates a larger error of the
/// band than the distance between two trial values.
constexpr double next_band = 1.3;
/// Smallest and largest trial value of the band, as shares of the largest pressure in the records.
constexpr double narrowest = 0.004, widest = 0.25;
/// Limits of an iteration that estimates the dead band and the model behind the valve in turn. The iteration
/// ends after `most_rounds` rounds. It ends earlier if the relative change of the band is below band_stays
/// and that of the mean square is below rest_stays.
constexpr int most_rounds = 20;
constexpr double band_stays = 5e-4, rest_stays = 0.01;
/// Number of rounds after which the jump distances must scatter less than random distances. If they do not,
/// the valve has no dead band.
constexpr int rounds_of_chance = 6;
/// Ratio of two sums of squares above which the difference cannot be a rounding error.
constexpr double clearly_more = 1 + 1e-9;

struct ValvePaths {
  std::vector<ValvePath> by_record;
  double sum_of_squares_mm2 = 0;
};

ValvePaths track_all(const std::vector<Record>& records, const FitPoint& point, double band_kpa,
                     double resolution_kpa, unsigned threads) {
  ValvePaths all;
  all.by_record.resize(records.size());
  parallel_for(records.size(), threads, [&](std::size_t k) {
    all.by_record[k] = track_jumps(records[k], k, point, band_kpa, resolution_kpa);
  });
  for (const ValvePath& path : all.by_record) all.sum_of_squares_mm2 += path.sum_of_squares_mm2;
  return all;
}

/// Returns the band with the smallest tracking error. If several bands have the same error, returns the first
/// one. The computation for a band stops when its error exceeds the total error of another band.
double best_band(const std::vector<Record>& records, const FitPoint& point, const std::vector<double>& bands,
                 double resolution_kpa, unsigned threads) {
  std::vector<double> left(bands.size(), std::numeric_limits<double>::infinity());
  std::atomic<double> least{std::numeric_limits<double>::infinity()};
  parallel_for(bands.size(), threads, [&](std::size_t i) {
    double sum_mm2 = 0;
    for (std::size_t k = 0; k < records.size() && std::isfinite(sum_mm2); ++k)
      sum_mm2 += track_jumps(records[k], k, point, bands[i], resolution_kpa, clearly_more * (least - sum_mm2))
                     .sum_of_squares_mm2;
    left[i] = sum_mm2;
    for (double known = least; sum_mm2 < known && !least.compare_exchange_weak(known, sum_mm2);) {
    }
  });
  return bands[static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin())];
}

/// Returns the trial values of the band [kPa], in ascending order. The smallest value is so large that the
/// readings can resolve the jumps of the valve.
/// @param resolution_kpa  largest pressure difference that the readings cannot resolve.
std::vector<double> bands_of(const Scales& scales, double resolution_kpa) {
  std::vector<double> bands;
  double band = std::max(narrowest * scales.largest_kpa, 4 * resolution_kpa);
  while (band < widest * scales.largest_kpa) {
    bands.push_back(band);
    band *= next_band;
  }
  return bands;
}

/// Returns the sorted jump distances of all records.
std::vector<double> distances_of(const ValvePaths& paths) {
  std::vector<double> distances;
  for (const ValvePath& path : paths.by_record)
    distances.insert(distances.end(), path.distances_kpa.begin(), path.distances_kpa.end());
  std::sort(distances.begin(), distances.end());
  return distances;
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Computes the mean and the scatter of the sorted jump distances. The smallest 5 % and the largest 5 % are
/// excluded: if a jump is detected one sample too late, its distance is wrong.
void measure_band(std::span<const double> distances, StickSlip& found) {
  found.jumps = distances.size();
  if (distances.size() < limits::fewest_events) return;
  const std::size_t cut = distances.size() / 20;
  const auto kept = distances.subspan(cut, distances.size() - 2 * cut);
  found.band_kpa = mean(kept);
  double variance = 0;
  for (const double d : kept) variance += square(d - found.band_kpa) / (static_cast<double>(kept.size()) - 1);
  found.scatter = std::sqrt(variance) / found.band_kpa;
}

std::vector<Record> driven(const std::vector<Record>& records, const ValvePaths& paths) {
  std::vector<Record> all;
  for (std::size_t k = 0; k < records.size(); ++k) all.push_back(driven_by(records[k], paths.by_record[k]));
  return all;
}

/// Estimates the stick-slip motion by iteration, starting from a value of the band. Returns nullopt if there
/// are too few jumps or if the jump distances scatter like random distances.
std::optional<StickSlip> stick_slip_from(const std::vector<Record>& records, const StructureFit& behind,
                                         double band_kpa, double resolution_kpa, unsigned threads) {
  StickSlip found;
  found.band_kpa = band_kpa;
  found.fit = behind;
  std::vector<double> distances;
  for (int round = 0; round < most_rounds; ++round) {
    const double before_kpa = found.band_kpa, before_mm2 = found.fit.mean_square_mm2;
    const ValvePaths paths = track_all(records, found.fit.point, found.band_kpa, resolution_kpa, threads);
    distances = distances_of(paths);
    measure_band(distances, found);
    if (found.jumps < limits::fewest_events ||
        (round >= rounds_of_chance && found.scatter > scatter_of_chance))
      return std::nullopt;
    found.records = driven(records, paths);
    found.fit = fit_structure(found.records, behind.causes, found.fit.point);
    if (std::abs(found.band_kpa - before_kpa) < band_stays * before_kpa &&
        found.fit.mean_square_mm2 > (1 - rest_stays) * before_mm2)
      break;
  }
  const Band band = band_of_jumps(distances);
  found.band_kpa = band.value_kpa;
  found.band_ci95 = band.ci95_kpa;
  return found;
}

/// Returns the pressure change that moves the finger by half the noise [kPa].
double resolution_of(const Scales& scales, double noise_mm) {
  return 0.5 * noise_mm * scales.largest_kpa / scales.span_mm;
}

bool is_a_band(const StickSlip& found, double resolution_kpa) {
  return found.scatter <=
         std::min(std::hypot(most_scatter, resolution_kpa / found.band_kpa), most_scatter_in_all);
}

}  // namespace

Band band_of_jumps(std::span<const double> distances_kpa) {
  const std::size_t cut = distances_kpa.size() / 4;
  const auto middle = distances_kpa.subspan(cut, distances_kpa.size() - 2 * cut);
  const double band_kpa = mean(middle);
  double winsorised = 0;
  for (const double d : distances_kpa)
    winsorised += square(std::clamp(d, middle.front(), middle.back()) - band_kpa);
  const auto count = static_cast<double>(distances_kpa.size()), kept = static_cast<double>(middle.size());
  const double half = t_quantile(kept - 1) * std::sqrt(winsorised / (count - 1) * count) / kept;
  return {band_kpa, {band_kpa - half, band_kpa + half}};
}

std::optional<StickSlip> find_stick_slip(const std::vector<Record>& records, const StructureFit& behind,
                                         double noise_mm, unsigned threads) {
  const Scales scales = scales_of(records);
  if (scales.largest_kpa <= 0 || scales.span_mm <= 0) return std::nullopt;
  const double resolution_kpa = resolution_of(scales, noise_mm);
  const std::vector<double> bands = bands_of(scales, resolution_kpa);
  if (bands.empty()) return std::nullopt;
  const double band_kpa = best_band(records, behind.point, bands, resolution_kpa, threads);
  // The start value may be below the true band. A path can then reach nearly every valve position by short
  // jumps. As long as the model behind the valve is inaccurate, the error of this path is smaller than that
  // of the true path. Therefore a second search starts at twice the band.
  for (const double start_kpa : {band_kpa, 2 * band_kpa}) {
    auto found = stick_slip_from(records, behind, start_kpa, resolution_kpa, threads);
    if (found && is_a_band(*found, resolution_kpa) && found->fit.mean_square_mm2 < behind.mean_square_mm2)
      return found;
  }
  return std::nullopt;
}

std::optional<StickSlip> stick_slip_without(const std::vector<Record>& records, const StickSlip& found,
                                            const Cause& cause, double noise_mm, unsigned threads) {
  const double resolution_kpa = resolution_of(scales_of(records), noise_mm);
  const StructureFit rest = fit_without_cause(found.records, found.fit, cause);
  auto again = stick_slip_from(records, rest, found.band_kpa, resolution_kpa, threads);
  if (!again || !is_a_band(*again, resolution_kpa)) return std::nullopt;
  return again;
}

}  // namespace softgrip::sysid
