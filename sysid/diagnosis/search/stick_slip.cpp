#include "sysid/diagnosis/search/stick_slip.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "base/statistics.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/jump_tracking.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/resampled_record.h"

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
/// Number of samples of a first search. If these samples contain limits::fewest_events jumps and no
/// stick-slip motion, the other samples are not searched. The standard error of a scatter of 20 distances is
/// 16 %, which is sufficient to distinguish equal distances from random ones.
constexpr std::size_t samples_of_first_search = 10'000;
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

/// Result of a search for a stick-slip motion.
struct Attempt {
  std::optional<StickSlip> found;
  std::size_t jumps = 0;  ///< number of jumps whose jump distance the readings resolve
};

/// Estimates the stick-slip motion by iteration, starting from a value of the band. Finds nothing if there
/// are too few jumps or if the jump distances scatter like random distances.
Attempt stick_slip_from(const std::vector<Record>& records, const StructureFit& behind, double band_kpa,
                        double resolution_kpa, unsigned threads) {
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
      return {std::nullopt, found.jumps};
    found.records = driven(records, paths);
    found.fit = fit_structure(found.records, behind.causes, found.fit.point);
    if (std::abs(found.band_kpa - before_kpa) < band_stays * before_kpa &&
        found.fit.mean_square_mm2 > (1 - rest_stays) * before_mm2)
      break;
  }
  static_cast<Band&>(found) = band_of_jumps(distances);
  const std::size_t jumps = found.jumps;
  return {std::move(found), jumps};
}

/// Returns the pressure change that moves the finger by half the noise [kPa].
double resolution_of(const Scales& scales, double noise_mm) {
  return 0.5 * noise_mm * scales.largest_kpa / scales.span_mm;
}

bool is_a_band(const StickSlip& found, double resolution_kpa) {
  return found.scatter <=
         std::min(std::hypot(most_scatter, resolution_kpa / found.band_kpa), most_scatter_in_all);
}

/// Returns true if a motion with a constant band was found that leaves a smaller error than `behind`.
bool explains(const Attempt& attempt, const StructureFit& behind, double resolution_kpa) {
  return attempt.found && is_a_band(*attempt.found, resolution_kpa) &&
         attempt.found->fit.mean_square_mm2 < behind.mean_square_mm2;
}

/// Searches for a stick-slip motion, starting from the trial value of the band with the smallest tracking
/// error.
Attempt search_bands(const std::vector<Record>& records, const StructureFit& behind,
                     const std::vector<double>& bands, double resolution_kpa, unsigned threads) {
  const double band_kpa = best_band(records, behind.point, bands, resolution_kpa, threads);
  // The start value may be below the true band. A path can then reach nearly every valve position by short
  // jumps. As long as the model behind the valve is inaccurate, the error of this path is smaller than that
  // of the true path. Therefore a second search starts at twice the band.
  std::array<Attempt, 2> attempts;
  parallel_for(attempts.size(), threads, [&](std::size_t i) {
    attempts[i] = stick_slip_from(records, behind, i == 0 ? band_kpa : 2 * band_kpa, resolution_kpa, threads);
  });
  for (Attempt& attempt : attempts) {
    if (explains(attempt, behind, resolution_kpa)) return std::move(attempt);
  }
  return {std::nullopt, std::max(attempts[0].jumps, attempts[1].jumps)};
}

/// Returns the cause "dead band" with only one form, the smooth form. The smooth form is the mean of all
/// possible stick-slip motions.
Cause dragged_along(Cause dead_band) {
  constexpr std::size_t play = model::block_type<model::ValveDeadband>();
  const auto form = std::find_if(dead_band.forms.begin(), dead_band.forms.end(),
                                 [](const CauseForm& one) { return one.type == play; });
  dead_band.forms = {form, 1};
  return dead_band;
}

/// Returns the structure with the dead band in its smooth form. If the structure has no dead band, the block
/// is added and the structure is refitted. The refit is necessary because a model without a dead band has
/// absorbed the mean lag of the valve.
std::optional<StructureFit> with_mean_of_stick_slip(const SearchData& data, const StructureFit& selected,
                                                    const Cause& dead_band) {
  if (position_of(selected.point.model, dead_band)) return selected;
  std::vector<Candidate> fits = fit_candidates(data, selected, {.only = {dragged_along(dead_band)}});
  return fits.empty() ? std::nullopt : std::move(fits.front().fit);
}

/// Adds one cause to a structure that contains the mean stick-slip motion. It is the cause that leaves the
/// smallest error. Such a second effect may have been missed before, because a single cause had to represent
/// both effects.
std::optional<StructureFit> with_second_effect(const SearchData& data, const StructureFit& beside) {
  std::optional<StructureFit> best;
  for (Candidate& candidate : fit_candidates(data, beside)) {
    if (!candidate.fit || is_free_form({candidate, {}})) continue;
    if (!best || candidate.fit->mean_square_mm2 < best->mean_square_mm2) best = std::move(candidate.fit);
  }
  return best;
}

/// Removes a cause that only replaced the stick-slip motion. This is done only if the selection has at least
/// two causes. A cause is removed if the error is not larger after a fit without the cause.
StickSlip without_stand_in(const SearchData& data, StickSlip found, double noise_mm) {
  if (found.fit.causes.size() < 2) return found;
  const std::vector<Cause> causes = found.fit.causes;
  for (const Cause& cause : causes) {
    auto rest = stick_slip_without(data.records, found, cause, noise_mm, data.threads);
    if (rest && rest->fit.mean_square_mm2 <= found.fit.mean_square_mm2) return std::move(*rest);
  }
  return found;
}

/// Searches for stick-slip motions with several structures of the finger. Keeps the result with the smallest
/// remaining error.
class BestStickSlip {
 public:
  BestStickSlip(const SearchData& data, const Cause& dead_band, double noise_mm)
      : data_(data), dead_band_(dead_band), noise_mm_(noise_mm) {}

  /// Searches for a stick-slip motion with the structure `beside`. Keeps the result if its remaining error is
  /// the smallest so far.
  /// @param beside  structure that contains the dead band in its smooth form.
  void look(const std::optional<StructureFit>& beside) {
    if (!beside) return;
    auto found = find_stick_slip(data_.records, without_cause(*beside, dead_band_), noise_mm_, data_.threads);
    if (found) found = without_stand_in(data_, std::move(*found), noise_mm_);
    if (!found || (best_ && found->fit.mean_square_mm2 > best_->fit.mean_square_mm2)) return;
    best_ = std::move(found);
  }
  /// Returns true if the remaining error is small. Then at most a few jumps of the valve can be wrong.
  [[nodiscard]] bool meets_all() const {
    return best_ && unexplained_error_of(best_->fit.residual_mm, noise_mm_, data_.scales.step_mm).excess_mm <
                        limits::tolerated_noise * noise_mm_;
  }
  [[nodiscard]] const std::optional<StickSlip>& best() const { return best_; }

 private:
  const SearchData& data_;
  const Cause& dead_band_;
  double noise_mm_;
  std::optional<StickSlip> best_;
};

/// Searches for a stick-slip motion with the base structure, and with the structure that contains all
/// selected causes. Returns the motion with the smaller remaining error. A selected cause may be a second
/// effect, or it may only replace the stick-slip motion. If neither structure leads to a stick-slip motion, a
/// base structure with a second effect is tried.
std::optional<StickSlip> stick_slip_before(const SearchData& data, const Selection& plain,
                                           const Cause& dead_band, double noise_mm) {
  BestStickSlip stick_slip(data, dead_band, noise_mm);
  const auto beside_base = with_mean_of_stick_slip(data, plain.base, dead_band);
  stick_slip.look(beside_base);
  if (!stick_slip.meets_all() && !plain.chosen.empty())
    stick_slip.look(with_mean_of_stick_slip(data, plain.extended, dead_band));
  if (!stick_slip.best() && beside_base) stick_slip.look(with_second_effect(data, *beside_base));
  return stick_slip.best();
}

/// Returns the fit of the base structure, without any cause, to records whose drive is the valve position.
StructureFit base_behind(const StickSlip& found) {
  StructureFit base = found.fit;
  for (const Cause& cause : found.fit.causes) base = without_cause(base, cause);
  return found.fit.causes.empty() ? base : fit_structure(found.records, {}, base.point);
}

/// Returns a copy of the point whose model contains the valve block in addition.
template <template <class> class Valve>
FitPoint with_valve(const FitPoint& behind, double band_kpa) {
  FitPoint point = behind;
  point.model = model::with_block(point.model, model::block_of<Valve>({{"band_kpa", band_kpa}}));
  return point;
}

/// Adds the dead band to the model for a simulation from the command alone. The jumping form is used if it
/// leads to the smaller held-out error, that is, if the simulated jumps stay synchronous with the readings.
/// Otherwise the smooth form is used.
void extend(Selection& selection, const SearchData& data, const StructureFit& behind, const Cause& dead_band,
            double band_kpa, const Division& division) {
  std::vector<Cause> causes{dead_band};
  causes.insert(causes.end(), behind.causes.begin(), behind.causes.end());
  StructureFit stick_slip =
      evaluate_structure(data.records, causes, with_valve<model::ValveStiction>(behind.point, band_kpa));
  StructureFit mean =
      fit_structure(data.records, causes, with_valve<model::ValveDeadband>(behind.point, band_kpa));
  stick_slip.free_parameters = mean.free_parameters;
  BlockLosses stick_slip_losses = held_out_losses(data.records, division, stick_slip);
  BlockLosses mean_losses = held_out_losses(data.records, division, mean);
  const bool in_step = rmse_mm(stick_slip_losses) < rmse_mm(mean_losses);
  selection.extended = in_step ? std::move(stick_slip) : std::move(mean);
  selection.extended_losses = in_step ? std::move(stick_slip_losses) : std::move(mean_losses);
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
  const std::vector<Record> first = first_samples(records, samples_of_first_search);
  if (reading_count(first) < reading_count(records)) {
    const StructureFit behind_first = evaluate_structure(first, behind.causes, behind.point);
    const Attempt attempt = search_bands(first, behind_first, bands, resolution_kpa, threads);
    if (attempt.found) {
      Attempt all =
          stick_slip_from(records, attempt.found->fit, attempt.found->band_kpa, resolution_kpa, threads);
      return explains(all, behind, resolution_kpa) ? std::move(all.found) : std::nullopt;
    }
    if (attempt.jumps >= limits::fewest_events) return std::nullopt;
  }
  return search_bands(records, behind, bands, resolution_kpa, threads).found;
}

std::optional<StickSlip> stick_slip_without(const std::vector<Record>& records, const StickSlip& found,
                                            const Cause& cause, double noise_mm, unsigned threads) {
  const double resolution_kpa = resolution_of(scales_of(records), noise_mm);
  const StructureFit rest = fit_without_cause(found.records, found.fit, cause);
  auto again = stick_slip_from(records, rest, found.band_kpa, resolution_kpa, threads).found;
  if (!again || !is_a_band(*again, resolution_kpa)) return std::nullopt;
  return again;
}

std::optional<StickSlipSelection> select_behind_stick_slip(const SearchData& data, const Selection& plain,
                                                           double noise_mm, const Division& division,
                                                           const SelectionOptions& options) {
  const Cause dead_band = *find_cause(causes::ValveDeadband::id);
  if (position_of(data.given.model, dead_band)) return std::nullopt;
  const auto found = stick_slip_before(data, plain, dead_band, noise_mm);
  if (!found) return std::nullopt;

  SearchData driven = make_search_data(found->records, data.given.model);
  driven.threads = data.threads;
  StructureFit base = base_behind(*found);
  driven.scales.residual_lines = spectrum_peaks(driven.records, base.residual_mm);
  // A few wrong jumps of the valve leave an error. If the remaining error is small, no second cause is
  // searched, because a second cause would only represent the wrong jumps.
  SelectionOptions behind = options;
  if (!leaves_too_much(unexplained_error_of(base.residual_mm, noise_mm, data.scales.step_mm),
                       plain.base_unexplained, noise_mm))
    behind.most_causes = 0;
  Selection beyond = select_causes(driven, std::move(base), noise_mm, division, behind);

  StickSlipSelection result;
  result.evidence = {*found, rmse_mm(beyond.extended_losses),
                     gain_percent(plain.base_losses, beyond.extended_losses, options.seed)};
  result.selection = plain;
  result.selection.chosen = {chosen_cause(dead_band, plain.base_losses, beyond.base_losses, options.seed)};
  for (ChosenCause& more : beyond.chosen) result.selection.chosen.push_back(std::move(more));
  result.selection.left = beyond.left;
  extend(result.selection, data, beyond.extended, dead_band, found->band_kpa, division);
  return result;
}

}  // namespace softgrip::sysid
