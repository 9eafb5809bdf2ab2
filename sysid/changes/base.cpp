#include "sysid/changes/base.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/changes/base_candidate.h"
#include "sysid/changes/base_prediction.h"
#include "sysid/changes/filter_fit.h"
#include "sysid/changes/regulator.h"
#include "sysid/evidence/comparison.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

/// Order of the autoregression of the residual [bins]. The residual of a displacement has a longer
/// correlation time than the residual of a pressure. For a displacement, the autoregression therefore covers
/// at least finger_memory_in_units, in units of time_unit_s().
constexpr std::size_t whitening_order = 8;
constexpr double finger_memory_in_units = 0.4;
/// Sampling intervals of the search for changes, in units of time_unit_s(), if the bins have the length
/// shortest_bin_in_units(). Oscillations and lags of a finger that are faster need no samples, because the
/// form of a cause describes them. A valve responds faster than a finger.
constexpr double finger_samples_in_units = 0.01, valve_samples_in_units = 0.005;
/// Lower limits of the variation between several healthy runs. `least_gain_spread` applies to the relative
/// gain, and `least_zero_share` applies to the zero offset as a share of the span. No finger repeats more
/// accurately from day to day than these limits.
constexpr double least_gain_spread = 0.002;
constexpr double least_zero_share = 0.0005;

double shortest_bin_in_units(Drive drive) {
  return drive == Drive::command ? limits::search_interval_in_units : limits::finger_interval_in_units;
}

std::vector<Record> behind(const std::optional<Regulator>& regulator, const std::vector<Record>& records) {
  if (!regulator) return records;
  std::vector<Record> driven;
  driven.reserve(records.size());
  for (const Record& record : records) driven.push_back(behind(*regulator, record));
  return driven;
}

double mean_temperature(const std::vector<Record>& records) {
  double sum = 0, count = 0;
  for (const Record& record : records) {
    for (const double t : record.temperature_c) {
      sum += t;
      count += 1;
    }
  }
  return count > 0 ? sum / count : 20;
}

/// Returns the kinds of filter banks that are tried. If the input is the command, the filter bank may have to
/// represent the valve in addition to the finger.
std::vector<FilterKind> kinds_for(Judged judged, Drive drive) {
  if (judged == Judged::pressure) return {FilterKind::valve};
  if (drive == Drive::measured) return {FilterKind::finger};
  return {FilterKind::finger, FilterKind::valve_and_finger};
}

/// Results of the fits of one candidate. The candidate is fitted to all records, and once without each
/// cross-validation unit (sysid/evidence/units.h).
struct Fitted {
  std::vector<Record> driven;
  model::Model model;                  ///< model that was fitted to all records
  std::vector<model::Model> left_out;  ///< for each unit, the model that was fitted to the other units
  LeftByUnit left;                     ///< residuals of each fit
};
std::vector<Fitted> fit_all(const std::vector<BaseCandidate>& all, const std::vector<Record>& records,
                            const Base& base, unsigned threads) {
  std::vector<Fitted> fits(all.size());
  std::vector<FittedParameters> whole(all.size());
  const std::size_t units = base.units.count();
  std::vector<std::size_t> every(records.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  parallel_for(all.size(), threads, [&](std::size_t c) {
    fits[c].driven = behind(all[c].regulator, records);
    whole[c] = all[c].fit(fits[c].driven);
    fits[c].model = whole[c].point.model;
    fits[c].left.resize(units + 1);
    fits[c].left_out.resize(units);
    fits[c].left[units] = left_by(all[c], whole[c].point, every, fits[c].driven, base.bin_s);
  });
  parallel_for(all.size() * units, threads, [&](std::size_t task) {
    const std::size_t c = task / units, unit = task % units;
    LeftOutFit fit = fit_without(all[c], whole[c], fits[c].driven, base.units, unit, base.bin_s);
    fits[c].left_out[unit] = std::move(fit.model);
    fits[c].left[unit] = std::move(fit.left);
  });
  return fits;
}

/// Selects the baseline model. The first candidate is the default. Each further candidate replaces the best
/// earlier one only if it predicts left-out runs significantly better. The regulator of a candidate is fitted
/// to all runs. The cross-validation changes only the other parameters of the candidate.
void choose(Base& base, const std::vector<BaseCandidate>& all, const std::vector<Record>& records,
            const BaseOptions& options) {
  const std::vector<FilterKind> kinds = kinds_for(base.judged, base.drive);
  const std::vector<Fitted> fitted = fit_all(all, records, base, options.threads);
  std::vector<FittedFilters> fits(all.size() * kinds.size());
  // All candidates without a regulator have the same input, so one set of filter columns is computed for all
  // of them.
  std::vector<std::vector<std::size_t>> groups(1);
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c].regulator)
      groups.push_back({c});
    else
      groups.front().push_back(c);
  }
  parallel_for(groups.size() * kinds.size(), options.threads, [&](std::size_t task) {
    const std::vector<std::size_t>& group = groups[task / kinds.size()];
    const std::size_t k = task % kinds.size();
    if (group.empty()) return;
    std::vector<LeftByUnit> left;
    for (const std::size_t c : group) left.push_back(fitted[c].left);
    std::vector<FittedFilters> own = fit_filters(fitted[group.front()].driven, base.units, kinds[k],
                                                 base.bin_s, base.largest_kpa, left, options.seed);
    for (std::size_t i = 0; i < group.size(); ++i) fits[group[i] * kinds.size() + k] = std::move(own[i]);
  });
  std::vector<HealthyModel> models;
  std::size_t best = 0;
  for (std::size_t c = 0; c < all.size(); ++c) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      FittedFilters& filters = fits[c * kinds.size() + k];
      if (!std::isfinite(filters.left_mm)) continue;
      models.push_back({all[c].description,
                        fitted[c].model,
                        kinds[k],
                        all[c].regulator,
                        std::move(filters.weights),
                        filters.left_mm,
                        std::move(filters.left),
                        {}});
      for (std::size_t u = 0; u < base.units.count(); ++u)
        models.back().left_out.push_back({fitted[c].left_out[u], filters.without[u]});
      if (is_better(compare(losses_of(models[best].left, models.back().left, base.units, base.bin_s), 0,
                            options.seed)))
        best = models.size() - 1;
    }
    if (options.progress) options.progress(all[c].description);
  }
  if (models.empty()) return;
  static_cast<HealthyModel&>(base) = std::move(models[best]);
  models.erase(models.begin() + static_cast<std::ptrdiff_t>(best));
  // A further healthy run could have the error of the other model. The error between the halves of a single
  // run does not show this, because both halves have similar inputs.
  const double most =
      base.units.are_runs() ? std::sqrt(run_to_run_factor(base.units.runs())) : limits::comparable_ratio;
  std::erase_if(models, [&](const HealthyModel& each) { return each.left_mm > most * base.left_mm; });
  base.alternatives = std::move(models);
}

std::size_t order_for(const Base& base, double time_unit_s) {
  if (base.judged == Judged::pressure) return whitening_order;
  const double bins = finger_memory_in_units * time_unit_s / base.bin_s;
  return std::max(whitening_order, static_cast<std::size_t>(std::lround(bins)));
}

/// Returns the largest gain deviation of a further run. It is the smaller one of two values: a quantile for
/// the measured spread alone, and a quantile that also uses the usual spread of fingers. Two or three runs
/// measure their spread so roughly that the first value may exceed ten times the spread.
/// @param spread  relative spread of the gain between the runs.
/// @param free  degrees of freedom of the spread.
double free_gain_of(double spread, double free) {
  constexpr double more = limits::usual_gain_runs;
  const double pooled =
      std::sqrt((free * square(spread) + more * square(limits::usual_gain_spread)) / (free + more));
  return std::min(spread * t_quantile(free), pooled * t_quantile(free + more));
}

/// Computes the variation of the gain and of the zero offset between the healthy runs.
void spread(Base& base) {
  std::vector<PairSums> sums(base.units.count() * base.records.size());
  PairSums offsets;
  for (std::size_t r = 0; r < base.records.size(); ++r) {
    const Record& record = base.records[r];
    const std::vector<double> prediction = predict_base(base, record, {});
    const std::vector<double> motion = binned(record, prediction, base.bin_s);
    for (const double offset : binned(record, residual(record, prediction), base.bin_s))
      offsets.add(offset, offset);
    for (std::size_t b = 0; b < std::min(motion.size(), base.left[r].size()); ++b) {
      const std::size_t unit = base.units.unit_of(r, middle_s(b, base.bin_s));
      sums[r * base.units.count() + unit].add(motion[b], base.left[r][b]);
    }
  }
  double gains = 0, zeros = 0, zeros_squared = 0, count = 0;
  for (const PairSums& own : sums) {
    if (own.count < 10) continue;
    gains += square(own.covariance() / std::max(own.variance_x(), 1e-12));
    zeros += own.y / own.count;
    zeros_squared += square(own.y / own.count);
    count += 1;
  }
  const double free = std::max(1.0, count - 1);
  // The residuals of the cross-validation are not suitable here. If the units are halves of one run, the fit
  // to the other half has absorbed the zero offset of the run.
  base.zero_mm = offsets.count > 0 ? offsets.y / offsets.count : 0;
  // The displacement of a single healthy run does not show the spread of the gain between runs. Therefore a
  // spread of at least limits::usual_gain_spread is assumed, and `free_gain` is the difference between the
  // gains of two runs with this spread. Otherwise, the spread is estimated from the units.
  const bool is_assumed = !base.units.are_runs() && base.judged == Judged::displacement;
  base.gain_spread = std::max(is_assumed ? limits::usual_gain_spread : least_gain_spread,
                              count > 0 ? std::sqrt(gains / count) : 0);
  base.free_gain = is_assumed ? base.gain_spread * deviate_between_two_runs
                              : free_gain_of(base.gain_spread, static_cast<double>(base.units.count() - 1));
  base.zero_spread_mm =
      std::max(least_zero_share * base.span_mm,
               count > 0 ? std::sqrt(std::max(0.0, zeros_squared - zeros * zeros / count) / free) : 0);
}

double rms(const std::vector<double>& squares, const std::vector<double>& rows) {
  const double count = std::accumulate(rows.begin(), rows.end(), 0.0);
  return count > 0 ? std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / count) : 0;
}

}  // namespace

double finger_bin_s(const std::vector<Record>& records) {
  return bin_s(records, limits::finger_interval_in_units * time_unit_s(records));
}

Binned left_out_by_play(const std::vector<Record>& records, Drive drive, double bin_s, unsigned threads) {
  const Units units(records);
  const BaseCandidate play = play_candidate(drive);
  const FittedParameters whole = play.fit(records);
  std::vector<Binned> fitted_without(units.count());
  parallel_for(units.count(), threads, [&](std::size_t unit) {
    fitted_without[unit] = fit_without(play, whole, records, units, unit, bin_s).left;
  });
  Binned left = fitted_without.front();
  for (std::size_t r = 0; r < left.size(); ++r) {
    for (std::size_t b = 0; b < left[r].size(); ++b) {
      const double at_s = middle_s(b, bin_s);
      left[r][b] = at_s > begin_s(records[r]) ? fitted_without[units.unit_of(r, at_s)][r][b]
                                              : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return left;
}

Record thinned_for(const Base& base, const Record& record) {
  const double samples = base.judged == Judged::pressure ? valve_samples_in_units : finger_samples_in_units;
  return thinned_to_centres(record, base.bin_s / (shortest_bin_in_units(base.drive) / samples));
}

Base fit_base(const std::vector<Record>& all_samples, Judged judged, Drive drive,
              const BaseOptions& options) {
  Base base;
  base.judged = judged;
  base.drive = drive;
  base.bin_s = bin_s(all_samples, shortest_bin_in_units(drive) * time_unit_s(all_samples));
  std::vector<Record> records = all_samples;
  if (2 * options.later_interval_s > base.bin_s) {
    for (Record& record : records) record = thinned_to(record, options.later_interval_s);
    base.bin_s = bin_s(records, 2 * options.later_interval_s);
  }
  base.temperature_c = mean_temperature(records);
  const CampaignSize size = campaign_size(records);
  base.largest_kpa = size.largest_kpa;
  base.span_mm = size.span_mm;
  for (const Record& record : records) base.noise_mm = std::max(base.noise_mm, fast_noise_mm(record));
  base.units = Units(records);
  choose(base, base_candidates(records, judged, drive, base.largest_kpa, options), records, options);
  Binned peak_rate;
  for (const Record& record : records) peak_rate.push_back(peak_rate_of(record, base.bin_s));
  base.whitener = whitener_of(base.left, peak_rate, order_for(base, time_unit_s(all_samples)));
  for (const Record& record : records) base.records.push_back(thinned_for(base, record));
  spread(base);
  return base;
}

std::vector<Record> pressure_records(const std::vector<Log>& logs, bool held) {
  std::vector<Log> swapped = logs;
  for (Log& log : swapped) log.displacement_mm = log.pressure_kpa;
  return make_records(swapped, {.drive = Drive::command, .held = held});
}

DriveChoice chosen_drive(const std::vector<Record>& by_pressure, const std::vector<Record>& by_command,
                         std::uint64_t seed, unsigned threads) {
  const double bin_s = finger_bin_s(by_pressure);
  const Units units(by_pressure);
  const PairedLosses losses =
      losses_of(left_out_by_play(by_pressure, Drive::measured, bin_s, threads),
                left_out_by_play(by_command, Drive::command, bin_s, threads), units, bin_s);
  DriveChoice choice{Drive::measured, rms(losses.worse, losses.rows), rms(losses.better, losses.rows)};
  const bool beyond_spread =
      square(choice.by_pressure_mm) > run_to_run_factor(units.runs()) * square(choice.by_command_mm);
  if (beyond_spread && is_better(compare(losses, 0, seed))) choice.drive = Drive::command;
  return choice;
}

}  // namespace softgrip::sysid
