#include "sysid/changes/change.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "base/statistics.h"
#include "base/thread_budget.h"
#include "sysid/changes/chance.h"
#include "sysid/changes/change_search.h"
#include "sysid/changes/change_size.h"
#include "sysid/diagnosis/causes/outliers.h"
#include "sysid/diagnosis/causes/thermal_gain.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

/// A change is at least so large, of what the base usually leaves of healthy readings, either as they are or
/// whitened: a fast oscillation is seen beside slow misses that are larger.
constexpr double least_size = 0.5;
/// From here on the temperature is the finger's own.
constexpr double own_temperature_gain = 0.05;
/// A further cause takes at least this share of what is left.
constexpr double further_share = 0.4;
constexpr std::size_t most_causes = 3;
/// Left beyond the healthy spread by more than this, in whitened mean squares: structure.
constexpr double misfit_allowed = 1.35;
/// A cause that gains less than this share of another one's, in the other reading, may follow from it: a base
/// is less certain of a course that it never saw.
constexpr double beside_another = 0.02;
/// Where a bend is the finger's or the sensor's, only its law would tell, which nobody knows so well: of
/// twins of changed worlds (--first-seed 20261204) the lesser took 94 % at least.
constexpr double twins_share = 0.9;
/// How often, blocks drawn anew, a cause must take something to be a change, and win against another one to
/// stand alone.
constexpr double often = 0.95;

using Failure = tl::unexpected<std::string>;

struct Prepared {
  std::vector<Record> records;
  OutlierEvidence outliers;
};

Prepared prepared(std::vector<Record> records) {
  Prepared p{std::move(records), {}};
  p.outliers = hide_outliers(p.records, measured_noise_mm(p.records));
  return p;
}

double rms_of(const Binned& series, double zero) {
  double sum = 0, count = 0;
  for (const std::vector<double>& part : series) {
    for (const double v : part) {
      if (!std::isfinite(v)) continue;
      sum += (v - zero) * (v - zero);
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

/// Whatever it leaves in a few hasty moments.
double usual_left(const Binned& left) {
  std::vector<double> sizes;
  for (const std::vector<double>& part : left) {
    for (const double v : part) {
      if (std::isfinite(v)) sizes.push_back(std::abs(v));
    }
  }
  constexpr double of_normal = 1.4826;
  return of_normal * median_of(std::span(sizes));
}

Binned minus(Binned from, const Binned& what) {
  for (std::size_t r = 0; r < from.size(); ++r) {
    for (std::size_t b = 0; b < from[r].size(); ++b) from[r][b] -= what[r][b];
  }
  return from;
}

/// One reading from its healthy records to what it shows of the later ones.
class Judge {
 public:
  Judge(Base base, const ChangeOptions& options, bool pressure_is_judged)
      : base_(std::move(base)), options_(options), pressure_is_judged_(pressure_is_judged) {}

  void judge(const std::vector<Record>& later, ChangeDiagnosis& diagnosis) {
    learn_temperature();
    say("what chance shows on the healthy logs");
    const Chance chance =
        chance_of(LaterReadings(base_, base_.records, base_.left),
                  effects_for(base_, base_.records, {}, pressure_is_judged_), options_.threads);
    const std::vector<std::vector<double>> residuals = residuals_of(base_, later);
    const LaterReadings readings = readings_of(base_, later, residuals);
    const std::vector<Effect> effects =
        effects_for(base_, later, spectrum_peaks(later, residuals), pressure_is_judged_);
    JudgedChange judged;
    judged.judged = base_.judged;
    judged.base = base_.description;
    judged.noise_mm = base_.noise_mm;
    judged.healthy_mm = base_.left_mm;
    std::vector<FittedEffect> found;
    Eigen::VectorXd white = readings.white(found);
    judged.misfit_before = judged.misfit_left = per_bin(readings, white.squaredNorm());
    for (std::size_t step = 0; step < most_causes; ++step) {
      say("which changes the later logs show");
      std::vector<ScoredEffect> ranked = ranked_effects(readings, effects, found, chance, options_.threads);
      if (step == 0) {
        for (const ScoredEffect& each : ranked)
          judged.tried.push_back(
              {each.fit.fitted.effect.id, each.fit.fitted.effect.form, each.gain, each.chance});
      }
      const Weighed weighed = weigh_first_change(readings, ranked, white, found);
      const double excess_left = judged.misfit_left - 1;
      if (ranked.empty() || !(found.empty() || ranked.front().gain > further_share * excess_left)) break;
      const ScoredEffect& best = ranked.front();
      diagnosis.causes.push_back(cause_of(readings, ranked, weighed, judged.misfit_before - 1));
      found.push_back(best.fit.fitted);
      white = best.fit.white;
      judged.misfit_left = per_bin(readings, white.squaredNorm());
      if (!(judged.misfit_left > misfit_allowed)) break;
    }
    add_intervals(intervals_of(readings, found), diagnosis.causes);
    finish(readings, found, judged);
    diagnosis.readings.push_back(std::move(judged));
  }

 private:
  void say(const std::string& text) const {
    if (options_.progress) options_.progress(text);
  }

  /// A gain that follows the temperature on the healthy logs already is the finger's own, on any day.
  void learn_temperature() {
    std::vector<Effect> effects = effects_for(base_, base_.records, {}, pressure_is_judged_);
    std::erase_if(effects, [](const Effect& e) { return e.id != causes::ThermalGain::id; });
    if (effects.empty()) return;
    const LaterReadings healthy(base_, base_.records, base_.left);
    const std::vector<ScoredEffect> ranked = ranked_effects(healthy, effects, {}, {}, options_.threads);
    if (!(ranked.front().gain > own_temperature_gain)) return;
    FittedEffect own = ranked.front().fit.fitted;
    own.numbers.back() = 0;  // the gain at the mean temperature is the base's already
    base_.left = minus(std::move(base_.left), healthy.added({own}));
    base_.gain_per_c = own.numbers.front();
  }

  [[nodiscard]] bool is_large(const LaterReadings& readings, const Binned& added) const {
    return rms_of(added, 0) >= least_size * usual_left(base_.left) ||
           per_bin(readings, readings.rows()(added).squaredNorm()) >= least_size * least_size;
  }

  static double per_bin(const LaterReadings& readings, double value) {
    return value / static_cast<double>(readings.rows().rows().size());
  }

  /// An effect beside the readings without it.
  struct Weighed {
    Binned added;
    std::vector<double> block_sums;  ///< with it
    Resampled spread;                ///< of what it takes
    bool is_a_change = false;        ///< by its size and over blocks drawn anew
  };

  /// @param without  the whitened readings without it. @param found  what is there beside it.
  [[nodiscard]] Weighed weigh(const LaterReadings& readings, const ScoredEffect& scored,
                              const Eigen::VectorXd& without, std::vector<FittedEffect> found) const {
    Weighed weighed;
    weighed.added = readings.added({scored.fit.fitted});
    weighed.block_sums = block_sums(readings, scored.fit.white);
    weighed.spread = resampled(block_sums(readings, without), weighed.block_sums, options_.seed);
    const double without_it = readings.plain_rms(found);
    found.push_back(scored.fit.fitted);
    // What takes the prediction farther from what was measured, and is there only once the readings are
    // whitened, is the shape of the base's own misses.
    weighed.is_a_change = is_large(readings, weighed.added) && weighed.spread.share > often &&
                          readings.plain_rms(found) < without_it;
    return weighed;
  }

  /// Leaves of the ranked those that stand out, the first that is a change in front: what chance alone makes
  /// gain more does not hide it.
  [[nodiscard]] Weighed weigh_first_change(const LaterReadings& readings, std::vector<ScoredEffect>& ranked,
                                           const Eigen::VectorXd& without,
                                           const std::vector<FittedEffect>& found) const {
    std::erase_if(ranked, [&](const ScoredEffect& each) { return !stands_out(each, base_); });
    for (; !ranked.empty(); ranked.erase(ranked.begin())) {
      put_fewest_numbers_first(ranked);
      Weighed weighed = weigh(readings, ranked.front(), without, found);
      if (weighed.is_a_change) return weighed;
    }
    return {};
  }

  /// Whether another effect explains as much as the best one.
  [[nodiscard]] bool is_rival(const LaterReadings& readings, const ScoredEffect& best,
                              const ScoredEffect& other, const Weighed& weighed) const {
    const Effect& effect = best.fit.fitted.effect;
    if (takes_as_much(other, best)) return true;
    if (other.fit.fitted.effect.id == effect.twin && other.gain > twins_share * best.gain) return true;
    const double dearer = price_of(other.fit.fitted.effect) - price_of(effect);
    const std::vector<double> sums = block_sums(readings, other.fit.white);
    return resampled(sums, weighed.block_sums, options_.seed, dearer).share < often;
  }

  [[nodiscard]] ChangeCause cause_of(const LaterReadings& readings, const std::vector<ScoredEffect>& ranked,
                                     const Weighed& weighed, double excess) const {
    const FittedEffect& best = ranked.front().fit.fitted;
    ChangeCause cause;
    cause.id = best.effect.id;
    cause.title = best.effect.title;
    cause.station = best.effect.station;
    cause.judged = base_.judged;
    cause.fitted = best;
    cause.gain = ranked.front().gain;
    cause.gain_lower = per_bin(readings, weighed.spread.lower);
    cause.gain_upper = per_bin(readings, weighed.spread.upper);
    for (std::size_t i = 1; i < ranked.size(); ++i) {
      if (is_rival(readings, ranked.front(), ranked[i], weighed))
        cause.rivals.push_back(ranked[i].fit.fitted.effect.id);
    }
    cause.effect_mm = rms_of(weighed.added, 0);
    cause.full_pressure_mm = at_full_pressure(readings, weighed.added);
    cause.size = size_of(readings, best, cause.full_pressure_mm);
    cause.share_percent = excess > 0 ? std::clamp(100 * cause.gain / excess, 0.0, 100.0) : 0;
    return cause;
  }

  /// To the causes that were found last.
  static void add_intervals(const std::vector<EffectIntervals>& intervals, std::vector<ChangeCause>& causes) {
    const std::size_t before = causes.size() - intervals.size();
    for (std::size_t i = 0; i < intervals.size(); ++i) causes[before + i].intervals = intervals[i];
  }

  void finish(const LaterReadings& readings, const std::vector<FittedEffect>& found,
              JudgedChange& judged) const {
    judged.left_over = judged.misfit_left > misfit_allowed;
    judged.bin_s = base_.bin_s;
    for (const Record& record : readings.records()) judged.logs.push_back(record.name);
    judged.left = readings.left();
    judged.explained = found.empty() ? judged.left : minus(readings.left(), readings.added(found));
    const LaterReadings::Slack slack = readings.slack(found);
    judged.zero_mm = slack.zero_mm;
    judged.gain_percent = 100 * slack.gain;
    judged.later_mm = rms_of(readings.left(), readings.slack({}).zero_mm);
    judged.explained_mm = rms_of(judged.explained, slack.zero_mm);
  }

  Base base_;
  const ChangeOptions& options_;
  bool pressure_is_judged_;
};

bool has_pressure(const std::vector<Log>& logs) {
  return std::all_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
}

std::string objection_to(const std::vector<Log>& healthy, const std::vector<Log>& later) {
  if (healthy.empty() || later.empty()) return "A change needs healthy logs and later ones";
  const auto samples = [](const std::vector<Log>& logs) {
    std::size_t sum = 0;
    for (const Log& log : logs) sum += log.size();
    return sum;
  };
  constexpr std::size_t fewest = 400;
  if (samples(healthy) < fewest || samples(later) < fewest)
    return "A change needs " + std::to_string(fewest) + " samples of healthy logs and as many of later ones";
  return {};
}

void warn(const std::vector<Log>& healthy, const std::vector<Log>& later,
          std::vector<std::string>& warnings) {
  const double now_kpa = largest_command_kpa(later), then_kpa = largest_command_kpa(healthy);
  if (now_kpa > 1.05 * then_kpa)
    warnings.push_back("The later logs go to " + significant(now_kpa, 3) + " kPa, the healthy ones to " +
                       significant(then_kpa, 3) + " kPa: beyond it the base only guesses");
  if (has_pressure(healthy) != has_pressure(later))
    warnings.emplace_back(
        "pressure_kpa is recorded in one of the two only: the valve and the finger are judged as one");
}

/// Isolated wrong samples are counted, not fitted.
void judge_outliers(const OutlierEvidence& healthy, const OutlierEvidence& later, double noise_mm,
                    ChangeDiagnosis& diagnosis) {
  if (!later.present || later.share_low <= healthy.share_high) return;
  ChangeCause cause;
  const Cause known = *find_cause(causes::Outliers::id);
  cause.id = known.id;
  cause.title = known.title;
  cause.station = known.station;
  cause.size = {"wrong samples", 100 * later.share, "%"};
  cause.intervals.size = Interval{100 * later.share_low, 100 * later.share_high};
  cause.effect_mm = later.excess_mm;
  cause.share_percent = 100;
  cause.gain = noise_mm > 0 ? std::pow(later.excess_mm / noise_mm, 2) : 0;
  diagnosis.causes.push_back(std::move(cause));
}

ChangeVerdict verdict_of(const ChangeDiagnosis& d) {
  const bool left =
      std::any_of(d.readings.begin(), d.readings.end(), [](const JudgedChange& j) { return j.left_over; });
  const bool rivals =
      std::any_of(d.causes.begin(), d.causes.end(), [](const ChangeCause& c) { return !c.rivals.empty(); });
  if (d.causes.empty()) return left ? ChangeVerdict::unexplained : ChangeVerdict::unchanged;
  if (left) return ChangeVerdict::partly_explained;
  return rivals ? ChangeVerdict::ambiguous : ChangeVerdict::cause_found;
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
  const bool pressure = has_pressure(healthy) && has_pressure(later);
  const RecordOptions record{.drive = pressure ? Drive::measured : Drive::command, .held = options.held};
  const Prepared before = prepared(make_records(healthy, record));
  const Prepared after = prepared(make_records(later, record));
  judge_outliers(before.outliers, after.outliers, measured_noise_mm(after.records), diagnosis);
  const ThreadBudget budget(options.threads);
  const BaseOptions base{options.given, options.seed, options.threads, options.progress};
  if (pressure) {
    Judge valve(fit_base(pressure_records(healthy, options.held), Judged::pressure, Drive::command, base),
                options, true);
    valve.judge(pressure_records(later, options.held), diagnosis);
  }
  Judge finger(fit_base(before.records, Judged::displacement, record.drive, base), options, pressure);
  finger.judge(after.records, diagnosis);
  std::stable_sort(diagnosis.causes.begin(), diagnosis.causes.end(),
                   [](const ChangeCause& a, const ChangeCause& b) { return a.gain > b.gain; });
  if (!diagnosis.causes.empty()) {
    const double most = diagnosis.causes.front().gain;
    std::erase_if(diagnosis.causes, [&](const ChangeCause& c) { return c.gain < beside_another * most; });
  }
  diagnosis.verdict = verdict_of(diagnosis);
  diagnosis.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return diagnosis;
}

}  // namespace softgrip::sysid
