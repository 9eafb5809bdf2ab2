#include "sysid/changes/change.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/numbers.h"
#include "base/statistics.h"
#include "base/thread_budget.h"
#include "sysid/changes/base_prediction.h"
#include "sysid/changes/causes_without_block.h"
#include "sysid/changes/change_search.h"
#include "sysid/changes/change_size.h"
#include "sysid/changes/drive_choice.h"
#include "sysid/changes/filter_fit.h"
#include "sysid/diagnosis/causes/ageing.h"
#include "sysid/diagnosis/causes/outliers.h"
#include "sysid/diagnosis/causes/sampling.h"
#include "sysid/diagnosis/causes/thermal_gain.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/diagnosis/residual/sampling.h"
#include "sysid/evidence/limits.h"
#include "sysid/evidence/veto.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

/// A temperature coefficient counts as a property of the finger if it reduces the whitened mean square of the
/// healthy logs by more than this value.
constexpr double own_temperature_gain = 0.05;
constexpr std::size_t most_causes = 3;
/// A cause is dropped if its error reduction is below this share of the largest error reduction in pressure
/// or displacement. Such a cause may be a consequence of the cause with the largest reduction, because the
/// baseline model is less certain for an input to which it was not fitted.
constexpr double beside_another = 0.02;

using Failure = tl::unexpected<std::string>;

struct Prepared {
  std::vector<Record> records;
  double noise_mm = 0;
  OutlierEvidence outliers = {};
  SamplingEvidence sampling = {};
};

/// Returns the records of the logs. Outliers and repeated readings are hidden.
/// @param healthy_noise_mm  lower limit of the noise, so that readings within the noise of the healthy logs
/// are no outliers. The noise of later logs may be smaller, for example zero where a sensor saturates.
Prepared driven_records(const std::vector<Log>& logs, Drive drive, const ChangeOptions& options,
                        double healthy_noise_mm = 0) {
  Prepared p{.records = make_records(logs, {.drive = drive, .held = options.held})};
  p.sampling = hide_repeated(p.records);
  p.noise_mm = std::max(healthy_noise_mm, measured_noise_mm(p.records));
  p.outliers = hide_outliers(p.records, p.noise_mm);
  return p;
}

double rms_of(const Binned& series) {
  double sum = 0, count = 0;
  for (const std::vector<double>& part : series) {
    for (const double v : part) {
      if (!std::isfinite(v)) continue;
      sum += v * v;
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

double rms_about_mean(const std::vector<double>& series) {
  PairSums sums;
  for (const double v : series) sums.add(v, v);
  return sums.count > 0 ? std::sqrt(std::max(0.0, sums.variance_x())) / sums.count : 0;
}

Binned minus(Binned from, const Binned& what) {
  for (std::size_t r = 0; r < from.size(); ++r) {
    for (std::size_t b = 0; b < from[r].size(); ++b) from[r][b] -= what[r][b];
  }
  return from;
}

void add(PairedLosses& losses, const PairedLosses& more) {
  losses.worse.insert(losses.worse.end(), more.worse.begin(), more.worse.end());
  losses.better.insert(losses.better.end(), more.better.begin(), more.better.end());
  losses.rows.insert(losses.rows.end(), more.rows.begin(), more.rows.end());
}

double per_bin(const LaterReadings& readings, const Eigen::VectorXd& white) {
  return white.squaredNorm() / static_cast<double>(std::max<std::size_t>(1, readings.rows().rows().size()));
}

/// Searches for effects in each healthy unit. The prediction comes from a fit to the other units.
std::vector<HealthyFits> healthy_fits(const Base& base, bool pressure_is_judged, unsigned threads) {
  const LaterReadings all = healthy_readings(base);
  const std::vector<Effect> effects = effects_for(base, base.records, {}, pressure_is_judged);
  std::vector<HealthyFits> units;
  for (std::size_t unit = 0; unit < base.units.count(); ++unit) {
    LaterReadings readings = all.only(base.units, unit);
    if (readings.records().empty()) continue;
    std::vector<ScoredEffect> ranked = ranked_effects(readings, effects, {}, {}, threads);
    units.push_back({std::move(readings), std::move(ranked)});
  }
  return units;
}

Tolerance tolerance_of(const std::vector<HealthyFits>& healthy, std::size_t runs) {
  std::vector<NullGains> gains;
  for (const HealthyFits& unit : healthy) {
    gains.emplace_back();
    for (const ScoredEffect& each : unit.ranked) gains.back()[each.fit.fitted.effect.id] = each.gain;
  }
  return {gains, runs};
}

/// Errors of healthy units, each predicted by a fit to all other healthy units, and the largest permitted
/// error of another healthy run.
class RunSpread {
 public:
  RunSpread() = default;
  RunSpread(const std::vector<HealthyFits>& healthy, std::size_t runs)
      : factor_(run_to_run_factor(runs)), are_runs_(runs > 1) {
    for (const HealthyFits& unit : healthy) {
      const double rms = unit.readings.plain_rms({});
      mean_square_ += square(rms) / static_cast<double>(healthy.size());
      worst_rms_ = std::max(worst_rms_, rms);
      worst_loss_ = std::max(worst_loss_, per_bin(unit.readings, unit.readings.white({})));
    }
  }
  [[nodiscard]] double usual_rms() const { return std::sqrt(mean_square_); }
  [[nodiscard]] double allowed_rms() const { return std::sqrt(factor_ * mean_square_); }
  /// Returns true if the error exceeds the largest error that is expected in another healthy run.
  /// @param rms  RMS error of the readings without whitening.
  /// @param loss  mean square of the whitened readings; 1 for healthy units.
  [[nodiscard]] bool is_exceeded(double rms, double loss) const {
    return rms > allowed_rms() || loss > factor_;
  }
  /// Returns true if the error is large enough for a search for a change. If there are several healthy runs,
  /// the tolerance of the search is known. The error then only has to exceed that of each healthy run.
  [[nodiscard]] bool admits_a_change(double rms, double loss) const {
    return is_exceeded(rms, loss) || (are_runs_ && (rms > worst_rms_ || loss > worst_loss_));
  }

 private:
  double factor_ = 1, mean_square_ = 0, worst_rms_ = 0, worst_loss_ = 0;
  bool are_runs_ = false;
};

std::string other_start(const std::string& record) {
  return "No healthy log begins like " + record +
         " with respect to the pressure (pressurised or vented), so a slow change after the start of this "
         "log is not evaluated. Record a healthy log that begins in the same way";
}

/// Evaluates the displacement or the pressure: fits the baseline model to the healthy records and finds the
/// causes of a change in the later records.
class Judge {
 public:
  Judge(Base base, const ChangeOptions& options, bool pressure_is_judged)
      : base_(std::move(base)), options_(options), pressure_is_judged_(pressure_is_judged) {}

  void judge(const std::vector<Record>& later, ChangeDiagnosis& diagnosis) {
    learn_temperature();
    say("search for changes in each left-out healthy run");
    healthy_ = healthy_fits(base_, pressure_is_judged_, options_.threads);
    spread_ = RunSpread(healthy_, base_.units.runs());
    const Tolerance tolerance = tolerance_of(healthy_, base_.units.runs());
    const std::vector<std::vector<double>> residuals = residuals_of(base_, later);
    const LaterReadings readings = readings_of(base_, later, residuals);
    const std::vector<Effect> effects =
        effects_for(base_, later, spectrum_peaks(later, residuals), pressure_is_judged_);
    JudgedChange judged;
    judged.judged = base_.judged;
    judged.base = base_.description;
    judged.healthy_runs = base_.units.runs();
    judged.noise_mm = base_.noise_mm;
    judged.healthy_mm = spread_.usual_rms();
    judged.allowed_mm = spread_.allowed_rms();
    const std::vector<std::string> other_starts = readings.other_starts();
    for (const std::string& name : other_starts) diagnosis.warnings.push_back(other_start(name));
    std::vector<FittedEffect> found;
    Eigen::VectorXd white = readings.white(found);
    judged.loss_before = judged.loss_left = per_bin(readings, white);
    for (std::size_t step = 0; step < most_causes; ++step) {
      say("search for changes in the later logs");
      std::vector<ScoredEffect> ranked =
          ranked_effects(readings, effects, found, tolerance, options_.threads);
      if (step == 0) {
        for (const ScoredEffect& each : ranked)
          judged.tried.push_back({each.fit.fitted.effect.id,
                                  each.fit.fitted.effect.form,
                                  each.gain,
                                  each.usual,
                                  each.tolerance,
                                  {}});
      }
      // A further cause is searched for only if the remaining error exceeds the error that is expected in
      // another healthy run.
      const double rms = readings.plain_rms(found);
      const bool is_comparable = step == 0 && other_starts.empty();
      if (is_comparable ? !spread_.admits_a_change(rms, judged.loss_left)
                        : !spread_.is_exceeded(rms, judged.loss_left))
        break;
      const std::optional<ChangeCause> cause = first_change(readings, ranked, white, found, judged);
      if (!cause) break;
      diagnosis.causes.push_back(*cause);
      found.push_back(cause->fitted);
      white = readings.white(found);
      judged.loss_left = per_bin(readings, white);
    }
    finish(readings, effects, found, judged);
    diagnosis.readings.push_back(std::move(judged));
  }

 private:
  void say(const std::string& text) const {
    if (options_.progress) options_.progress(text);
  }

  /// Adds a temperature coefficient of the gain to the baseline model if the healthy logs show one. This
  /// coefficient is a property of the finger, not a change.
  void learn_temperature() {
    std::vector<Effect> effects = effects_for(base_, base_.records, {}, pressure_is_judged_);
    std::erase_if(effects, [](const Effect& e) { return e.id != causes::ThermalGain::id; });
    if (effects.empty()) return;
    const LaterReadings healthy = healthy_readings(base_);
    const std::vector<ScoredEffect> ranked = ranked_effects(healthy, effects, {}, {}, options_.threads);
    if (!(ranked.front().gain > own_temperature_gain)) return;
    FittedEffect own = ranked.front().fit.fitted;
    own.numbers.back() = 0;  // the baseline model already contains the gain at the mean temperature
    base_.left = minus(std::move(base_.left), healthy.added({own}));
    base_.gain_per_c = own.numbers.front();
  }

  static std::vector<FittedEffect> with(std::vector<FittedEffect> found, const FittedEffect& one) {
    found.push_back(one);
    return found;
  }

  /// Returns, for each row of the readings, true if the cause must have an effect at the operating point of
  /// this row.
  [[nodiscard]] std::vector<bool> required_rows(const LaterReadings& readings, Appears appears) const {
    Binned drive, rate;
    for (std::size_t r = 0; r < readings.records().size(); ++r) {
      const Record& record = readings.records()[r];
      const std::size_t bins = readings.left()[r].size();
      drive.push_back(with_bins(binned(record, record.drive_kpa, base_.bin_s), bins));
      rate.push_back(with_bins(peak_rate_of(record, base_.bin_s), bins));
    }
    std::vector<OperatingPoint> conditions;
    for (const auto& [r, b, spread] : readings.rows().rows())
      conditions.push_back({drive[r][b], rate[r][b], readings.plain()[r][b]});
    return required_at(appears, conditions);
  }

  /// Returns true if the effect makes predictions worse. It is fitted to all later units except one and then
  /// predicts this unit. Units in which the effect does not occur give no evidence. For example, half of a
  /// run may not reach the saturation of a sensor.
  [[nodiscard]] bool predicts_worse(const LaterReadings& readings, const Effect& effect,
                                    const std::vector<FittedEffect>& found) const {
    PairedLosses losses;
    if (effect.free_form) return false;
    const Units units(readings.records());
    for (std::size_t unit = 0; unit < units.count(); ++unit) {
      const LaterReadings rest = readings.without(units, unit), own = readings.only(units, unit);
      if (rest.records().empty() || own.records().empty()) continue;
      const EffectFit fit = fit_effect(rest, effect, found, rest.white(found));
      const std::vector<FittedEffect> all = with(found, fit.fitted);
      add(losses, losses_of(minus(own.left(), own.added(all)), minus(own.left(), own.added(found)),
                            Units(own.records()), base_.bin_s));
    }
    return is_better(compare(losses, 0, options_.seed));
  }

  /// Returns the largest possible size of a cause whose size has the unit `unit`. It is the range of the
  /// signal on which the cause acts.
  [[nodiscard]] double largest_size(const LaterReadings& readings, const std::string& unit) const {
    double length_s = 0;
    for (const Record& record : readings.records()) length_s = std::max(length_s, record.length_s());
    if (unit == "mm") return base_.span_mm;
    if (unit == "kPa") return base_.largest_kpa;
    if (unit == "s") return length_s;
    return std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] Veto vetoed(const LaterReadings& readings, const ScoredEffect& scored,
                            const Eigen::VectorXd& without, const std::vector<FittedEffect>& found) const {
    const FittedEffect& fitted = scored.fit.fitted;
    const std::vector<bool> required = required_rows(readings, fitted.effect.appears);
    Claim claim;
    claim.condition_met =
        static_cast<std::size_t>(std::count(required.begin(), required.end(), true)) >= limits::fewest_bins;
    if (!claim.condition_met) return veto_of(claim);
    const std::vector<FittedEffect> all = with(found, fitted);
    claim.size = intervals_of(readings, all, healthy_).back().size;
    const ChangeSize size = size_of(readings, fitted, at_full_pressure(readings, readings.added({fitted})));
    claim.largest_size = largest_size(readings, size.unit);
    claim.error_without = readings.plain_rms(found);
    claim.error_with = readings.plain_rms(all);
    claim.predicts_worse = predicts_worse(readings, fitted.effect, found);
    claim.shown_there =
        is_better(compare(paired_losses(readings, without, scored.fit.white, &required), 0, options_.seed));
    return veto_of(claim);
  }

  /// Returns the best effect that fulfils all conditions and whose error reduction exceeds its tolerance;
  /// nullopt if there is none. Stores the reasons why other effects were rejected.
  [[nodiscard]] std::optional<ChangeCause> first_change(const LaterReadings& readings,
                                                        std::vector<ScoredEffect> ranked,
                                                        const Eigen::VectorXd& without,
                                                        const std::vector<FittedEffect>& found,
                                                        JudgedChange& judged) const {
    const auto reject = [&](const ScoredEffect& scored, std::string_view reason) {
      for (TriedCause& tried : judged.tried) {
        if (tried.id == scored.fit.fitted.effect.id && tried.rejected.empty()) tried.rejected = reason;
      }
    };
    std::erase_if(ranked, [&](const ScoredEffect& each) {
      const Comparison against_none =
          compare(paired_losses(readings, without, each.fit.white),
                  each.tolerance + price_per_row(readings, each.fit.fitted.effect), options_.seed);
      if (is_better(against_none)) return false;
      reject(each, "the improvement does not exceed the improvement in healthy runs");
      return true;
    });
    const Ties ties = ties_in(readings, options_.seed);
    for (; !ranked.empty(); ranked.erase(ranked.begin())) {
      put_fewest_numbers_first(ranked, ties);
      const Veto veto = vetoed(readings, ranked.front(), without, found);
      if (veto == Veto::none) return cause_of(readings, ranked, ties, without, found);
      reject(ranked.front(), reason_of(veto));
    }
    return std::nullopt;
  }

  /// Returns true if the zero offset of the later logs [mm] differs significantly from the mean zero offset
  /// of the healthy runs. The difference must be larger than expected for a further healthy run.
  [[nodiscard]] bool is_another_zero(double zero_mm) const {
    const auto units = static_cast<double>(base_.units.count());
    return std::abs(zero_mm - base_.zero_mm) >
           t_quantile(units - 1) * base_.zero_spread_mm * std::sqrt(1 + 1 / units);
  }

  [[nodiscard]] ChangeCause cause_of(const LaterReadings& readings, const std::vector<ScoredEffect>& ranked,
                                     const Ties& ties, const Eigen::VectorXd& without,
                                     const std::vector<FittedEffect>& found) const {
    const FittedEffect& best = ranked.front().fit.fitted;
    const Binned added = readings.added({best});
    ChangeCause cause;
    cause.id = best.effect.id;
    cause.title = best.effect.title;
    cause.station = best.effect.station;
    cause.judged = base_.judged;
    cause.fitted = best;
    cause.gain = ranked.front().gain;
    const Comparison spread =
        compare(paired_losses(readings, without, ranked.front().fit.white), 0, options_.seed);
    cause.gain_lower = spread.lower;
    cause.gain_upper = spread.upper;
    for (std::size_t i = 1; i < ranked.size(); ++i) {
      if (ties(ranked.front(), ranked[i]) && vetoed(readings, ranked[i], without, found) == Veto::none)
        cause.alternatives.push_back(ranked[i].fit.fitted.effect.id);
    }
    if ((cause.id == causes::Ageing::WithTime::id ||
         std::count(cause.alternatives.begin(), cause.alternatives.end(), causes::Ageing::WithTime::id) >
             0) &&
        is_another_zero(readings.nuisance(with(found, best)).zero_mm))
      cause.alternatives.emplace_back(payload.id);
    cause.effect_mm = rms_of(added);
    cause.full_pressure_mm = at_full_pressure(readings, added);
    cause.size = size_of(readings, best, cause.full_pressure_mm);
    const double excess = per_bin(readings, without) - 1;
    cause.share_percent = excess > 0 ? std::clamp(100 * cause.gain / excess, 0.0, 100.0) : 0;
    return cause;
  }

  void finish(const LaterReadings& readings, const std::vector<Effect>& effects,
              const std::vector<FittedEffect>& found, JudgedChange& judged) const {
    judged.intervals = intervals_of(readings, found, healthy_);
    judged.left_over = spread_.is_exceeded(readings.plain_rms(found), judged.loss_left);
    judged.bin_s = base_.bin_s;
    for (const Record& record : readings.records()) judged.logs.push_back(record.name);
    judged.left = readings.left();
    judged.explained = found.empty() ? judged.left : minus(readings.left(), readings.added(found));
    for (std::size_t r = 0; r < base_.records.size(); ++r) {
      const double left = rms_about_mean(base_.left[r]);
      judged.runs.push_back({base_.records[r].name, true, left, left});
    }
    for (std::size_t r = 0; r < judged.logs.size(); ++r)
      judged.runs.push_back(
          {judged.logs[r], false, rms_about_mean(judged.left[r]), rms_about_mean(judged.explained[r])});
    const LaterReadings::Nuisance nuisance = readings.nuisance(found);
    judged.zero_mm = nuisance.zero_mm;
    judged.gain_percent = 100 * nuisance.gain;
    judged.later_mm = readings.plain_rms({});
    judged.explained_mm = readings.plain_rms(found);
    for (const Effect& effect : effects) {
      const std::vector<bool> required = required_rows(readings, effect.appears);
      if (static_cast<std::size_t>(std::count(required.begin(), required.end(), true)) < limits::fewest_bins)
        judged.not_tested.emplace(effect.id, recording_for(effect.appears));
    }
  }

  Base base_;
  const ChangeOptions& options_;
  bool pressure_is_judged_;
  std::vector<HealthyFits> healthy_;
  RunSpread spread_;
};

bool has_pressure(const std::vector<Log>& logs) {
  return std::all_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
}

std::string objection_to(const std::vector<Log>& healthy, const std::vector<Log>& later) {
  if (healthy.empty() || later.empty())
    return "The diagnosis of a change requires healthy logs and later logs";
  const auto samples = [](const std::vector<Log>& logs) {
    std::size_t sum = 0;
    for (const Log& log : logs) sum += log.size();
    return sum;
  };
  constexpr std::size_t fewest = 400;
  if (samples(healthy) < fewest || samples(later) < fewest)
    return "The diagnosis of a change requires " + std::to_string(fewest) +
           " samples of healthy logs and as many samples of later logs";
  return {};
}

void warn(const std::vector<Log>& healthy, const std::vector<Log>& later,
          std::vector<std::string>& warnings) {
  const double now_kpa = largest_command_kpa(later), then_kpa = largest_command_kpa(healthy);
  if (now_kpa > 1.05 * then_kpa)
    warnings.push_back("The later logs reach " + significant(now_kpa, 3) +
                       " kPa, but the healthy logs reach only " + significant(then_kpa, 3) +
                       " kPa: at higher pressures, the baseline model extrapolates and may be wrong");
  if (healthy.size() == 1)
    warnings.emplace_back(
        "One healthy log does not show how much healthy runs differ from each other. A change is therefore "
        "reported only if its error exceeds three times the error between the two halves of the healthy log. "
        "Record three or more healthy logs");
  if (has_pressure(healthy) != has_pressure(later))
    warnings.emplace_back(
        "pressure_kpa is recorded in only one of the two groups (healthy logs, later logs), so the valve and "
        "the finger are evaluated together");
}

std::string unused_pressure(const DriveChoice& choice) {
  return "Left-out healthy runs are predicted better from the command than from the measured pressure (" +
         significant(choice.by_command_mm, 2) + " and " + significant(choice.by_pressure_mm, 2) +
         " mm RMS), so pressure_kpa is not used";
}

/// Adds the causes that are found in the readings without a fit: isolated wrong readings, and repeated
/// readings.
void judge_readings(const Prepared& healthy, const Prepared& later, ChangeDiagnosis& diagnosis) {
  const auto add = [&](std::string_view id, ChangeSize size, std::optional<Interval> interval,
                       double excess_mm) {
    ChangeCause cause;
    const Cause known = *find_cause(id);
    cause.id = known.id;
    cause.title = known.title;
    cause.station = known.station;
    cause.size = std::move(size);
    cause.intervals.size = interval;
    cause.effect_mm = excess_mm;
    cause.share_percent = 100;
    cause.gain = later.noise_mm > 0 ? std::pow(excess_mm / later.noise_mm, 2) : 0;
    diagnosis.causes.push_back(std::move(cause));
  };
  const OutlierEvidence& outliers = later.outliers;
  if (outliers.present && outliers.share_low > healthy.outliers.share_high)
    add(causes::Outliers::id, {"wrong samples", 100 * outliers.share, "%"},
        Interval{100 * outliers.share_low, 100 * outliers.share_high}, outliers.excess_mm);
  const SamplingEvidence& sampling = later.sampling;
  constexpr double slower = 1.5;
  if (!sampling.present) return;
  if (sampling.frozen_s > slower * healthy.sampling.frozen_s)
    add(causes::Sampling::id, {"the reading is frozen for", sampling.frozen_s, "s"}, {}, sampling.excess_mm);
  else if (sampling.interval_s > slower * healthy.sampling.interval_s)
    add(causes::Sampling::id, {"time between two updates of the reading", sampling.interval_s, "s"}, {},
        sampling.excess_mm);
}

/// Copies the intervals to the causes. For each quantity, both lists are in the order in which the causes
/// were found.
void add_intervals(ChangeDiagnosis& diagnosis) {
  for (const JudgedChange& judged : diagnosis.readings) {
    auto next = judged.intervals.begin();
    for (ChangeCause& cause : diagnosis.causes) {
      if (cause.judged == judged.judged && !cause.fitted.effect.id.empty() && next != judged.intervals.end())
        cause.intervals = *next++;
    }
  }
}

ChangeVerdict verdict_of(const ChangeDiagnosis& d) {
  const bool left =
      std::any_of(d.readings.begin(), d.readings.end(), [](const JudgedChange& j) { return j.left_over; });
  const bool alternatives = std::any_of(d.causes.begin(), d.causes.end(),
                                        [](const ChangeCause& c) { return !c.alternatives.empty(); });
  if (d.causes.empty()) return left ? ChangeVerdict::unexplained : ChangeVerdict::unchanged;
  if (left) return ChangeVerdict::partly_explained;
  return alternatives ? ChangeVerdict::ambiguous : ChangeVerdict::cause_found;
}

}  // namespace

const char* name_of(ChangeVerdict verdict) {
  switch (verdict) {
    case ChangeVerdict::unchanged:
      return "unchanged";
    case ChangeVerdict::cause_found:
      return "cause_found";
    case ChangeVerdict::ambiguous:
      return "ambiguous";
    case ChangeVerdict::partly_explained:
      return "partly_explained";
    case ChangeVerdict::unexplained:
      break;
  }
  return "unexplained";
}

tl::expected<ChangeDiagnosis, std::string> diagnose_change(const std::vector<Log>& healthy,
                                                           const std::vector<Log>& later,
                                                           const ChangeOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  if (const std::string objection = objection_to(healthy, later); !objection.empty())
    return Failure(objection);
  ChangeDiagnosis diagnosis;
  warn(healthy, later, diagnosis.warnings);
  const ThreadBudget budget(options.threads);
  const BaseOptions base{options.given, options.seed, options.threads, options.progress};
  bool pressure = has_pressure(healthy) && has_pressure(later);
  Prepared before = driven_records(healthy, pressure ? Drive::measured : Drive::command, options);
  if (pressure) {
    Prepared commanded = driven_records(healthy, Drive::command, options);
    const DriveChoice choice = chosen_drive(before.records, commanded.records, options.seed, options.threads);
    if (choice.drive == Drive::command) {
      diagnosis.warnings.push_back(unused_pressure(choice));
      pressure = false;
      before = std::move(commanded);
    }
  }
  const Drive drive = pressure ? Drive::measured : Drive::command;
  const Prepared after = driven_records(later, drive, options, before.noise_mm);
  judge_readings(before, after, diagnosis);
  if (pressure) {
    Judge valve(fit_base(pressure_records(healthy, options.held), Judged::pressure, Drive::command, base),
                options, true);
    valve.judge(pressure_records(later, options.held), diagnosis);
  }
  Judge finger(fit_base(before.records, Judged::displacement, drive, base), options, pressure);
  finger.judge(after.records, diagnosis);
  add_intervals(diagnosis);
  std::stable_sort(diagnosis.causes.begin(), diagnosis.causes.end(),
                   [](const ChangeCause& a, const ChangeCause& b) { return a.gain > b.gain; });
  if (!diagnosis.causes.empty()) {
    const double most = diagnosis.causes.front().gain;
    std::erase_if(diagnosis.causes, [&](const ChangeCause& c) { return c.gain < beside_another * most; });
  }
  diagnosis.verdict = verdict_of(diagnosis);
  diagnosis.output_unit = healthy.front().output_unit;
  for (ChangeCause& cause : diagnosis.causes) cause.output_unit = diagnosis.output_unit;
  for (JudgedChange& judged : diagnosis.readings) judged.output_unit = diagnosis.output_unit;
  diagnosis.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return diagnosis;
}

}  // namespace softgrip::sysid
