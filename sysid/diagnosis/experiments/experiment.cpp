#include "sysid/diagnosis/experiments/experiment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/experiments/experiment_advice.h"
#include "sysid/diagnosis/experiments/separation.h"
#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Separation above which the result of an experiment is practically certain [standard deviations]. A larger
/// separation does not improve the rank of an experiment.
constexpr double certain_sigma = 40;
/// Number of waveforms whose separations are computed a second time with nonlinear fits. These are the
/// waveforms that the linear computation ranks first.
constexpr std::size_t confirmed = 2;
/// Time for a rig to come to rest before an experiment starts [s].
constexpr double rest_before_s = 10;

/// Competing explanations of the logs: a named cause and its alternatives. An experiment should separate
/// them.
struct Contest {
  std::vector<Hypothesis> hypotheses;  ///< one hypothesis per explanation; the first one contains the named
                                       ///< cause
  std::vector<std::string> ids;
};

struct Pair {
  std::size_t contest = 0;
  std::size_t one = 0;
  std::size_t other = 0;
  bool indistinguishable = false;
};

/// Returns the best two candidates, without the named cause.
/// @param named  nullptr: no cause is named.
std::vector<Cause> next_best(const std::vector<CandidateScore>& candidates, const Cause* named) {
  std::vector<Cause> causes;
  for (const CandidateScore& score : candidates) {
    const bool is_named = named != nullptr && score.cause == *named;
    if (causes.size() < 2 && !is_named && std::isfinite(score.heldout_rmse_mm)) causes.push_back(score.cause);
  }
  return causes;
}

/// Returns the reason why no experiment is designed if the diagnosis contains no causes that an experiment
/// can separate.
std::string without_pairs(const Diagnosis& d) {
  std::string open;
  for (const NamedCause& named : d.causes) {
    if (named.alternatives.empty()) continue;
    open += (open.empty() ? "" : ", ") + std::string(named.cause.id);
    for (const Cause& alternative : named.alternatives) open += " or " + std::string(alternative.id);
  }
  if (open.empty())
    return "No experiment was designed, because the diagnosis contains no two explanations that an "
           "experiment can separate.";
  return "No experiment can be designed for " + open +
         ", because these causes belong to a different model structure. Experiments are predicted only for "
         "the structure of the given model.";
}

class Designer {
 public:
  Designer(const Diagnosis& diagnosis, const ExperimentOptions& options) : d_(diagnosis), options_(options) {}

  NextExperiment run() {
    if (d_.verdict != Verdict::ambiguous && !options_.always) return {};
    prepare();
    if (pairs_.empty()) {
      result_.advice.push_back(without_pairs(d_));
      return std::move(result_);
    }
    judge();
    choose();
    advise();
    return std::move(result_);
  }

 private:
  void prepare() {
    std::vector<std::span<const double>> series;
    for (const auto& r : d_.extended.residual_mm) series.emplace_back(r);
    noise_ = fit_noise(autocovariance_of(series));
    noise_.innovation_mm = std::max(noise_.innovation_mm, 1e-6);
    data_ = make_search_data(d_.records, d_.as_given.point.model);
    data_.threads = options_.threads;
    data_.scales.residual_lines = spectrum_peaks(data_.records, d_.recalibrated.residual_mm);
    limits_ = options_.limits.value_or(RigLimits{.pressure_max_kpa = data_.scales.largest_kpa});
    for (const NamedCause& named : d_.causes) add_contest(named);
    if (d_.causes.empty()) add_contest_of_rejected();
    for (std::size_t c = 0; c < contests_.size(); ++c) {
      const std::size_t count = contests_[c].ids.size();
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j)
          pairs_.push_back({c, i, j, are_indistinguishable(c, i, j)});
      }
    }
  }

  [[nodiscard]] bool are_indistinguishable(std::size_t contest, std::size_t i, std::size_t j) const {
    const auto one = find_cause(contests_[contest].ids[i]);
    const auto other = find_cause(contests_[contest].ids[j]);
    return one && other && sysid::are_indistinguishable(*one, *other, d_.extended.point.model);
  }

  void add_contest(const NamedCause& named) {
    std::vector<Cause> alternatives = named.alternatives;
    if (alternatives.empty() && options_.always) alternatives = next_best(named.candidates, &named.cause);
    if (alternatives.size() > limits::most_alternatives) alternatives.resize(limits::most_alternatives);
    const std::vector<Cause>& standing = d_.extended.causes;
    const bool stands = std::find(standing.begin(), standing.end(), named.cause) != standing.end();
    if (alternatives.empty() || !stands) return;
    const StructureFit rest = d_.extended.causes.size() > 1
                                  ? fit_without_cause(data_.records, d_.extended, named.cause)
                                  : d_.recalibrated;
    add_contest(rest, alternatives, std::string(named.cause.id), d_.extended);
  }

  /// Adds a comparison between the refitted model and at most two rejected causes. The comparison is used if
  /// the verdict names no cause.
  void add_contest_of_rejected() {
    const std::vector<Cause> alternatives = next_best(d_.rejected, nullptr);
    if (!alternatives.empty()) add_contest(d_.recalibrated, alternatives, "none", d_.recalibrated);
  }

  void add_contest(const StructureFit& rest, const std::vector<Cause>& alternatives,
                   const std::string& first_id, const StructureFit& first) {
    Contest contest;
    contest.ids.push_back(first_id);
    contest.hypotheses.emplace_back(d_.records, first, noise_);
    for (Candidate& candidate : fit_candidates(data_, rest, {.only = alternatives})) {
      if (!candidate.fit) continue;
      contest.ids.emplace_back(candidate.cause.id);
      contest.hypotheses.emplace_back(d_.records, std::move(*candidate.fit), noise_);
    }
    contests_.push_back(std::move(contest));
  }

  /// Returns the waveform as a record that follows the last log. Temperature and supply pressure keep the
  /// values from the end of the last log.
  [[nodiscard]] Record record_of(const Waveform& waveform) const {
    const Record& last = d_.records.back();
    Record record;
    record.name = waveform.name;
    const double interval_s = std::round(1e6 * data_.scales.sample_s) / 1e6;
    record.drive_kpa = sampled_kpa(waveform, interval_s);
    const std::size_t count = record.drive_kpa.size();
    for (std::size_t i = 0; i < count; ++i) record.time_s.push_back(static_cast<double>(i) * interval_s);
    record.duration_s.assign(count, interval_s);
    record.duration_s[0] = 0;
    record.reading_mm.assign(count, std::numeric_limits<double>::quiet_NaN());
    if (!last.temperature_c.empty()) record.temperature_c.assign(count, last.temperature_c.back());
    if (!last.supply_kpa.empty()) record.supply_kpa.assign(count, last.supply_kpa.back());
    record.sample_time_s = interval_s;
    record.finest_interval_s = interval_s;
    record.campaign_time_s = last.campaign_time_s + last.time_s.back();
    record.span_mm = data_.scales.span_mm;
    record.largest_kpa = limits_.pressure_max_kpa;
    record.largest_before_kpa = std::max(last.largest_before_kpa, last.largest_kpa);
    record.held = last.held;
    record.offset_free = d_.records.front().offset_free;
    return record;
  }

  enum class Way { linear, refitted };

  [[nodiscard]] double distance(const Record& record, const Pair& pair, Way way) const {
    const Contest& contest = contests_[pair.contest];
    // No waveform separates indistinguishable causes, so the distance is 0. A computed distance would be
    // larger than 0 because the blocks of the two causes have slightly different equations.
    if (pair.indistinguishable) return 0;
    const auto from = [&](std::size_t truth, std::size_t alternative) {
      const std::vector<double> truth_mm = contest.hypotheses[truth].prediction(record);
      const bool finite =
          std::all_of(truth_mm.begin(), truth_mm.end(), [](double y) { return std::isfinite(y); });
      if (!finite) return 0.0;
      return way == Way::linear ? contest.hypotheses[alternative].linear_distance(record, truth_mm)
                                : contest.hypotheses[alternative].refitted_distance(record, truth_mm);
    };
    return std::min(from(pair.one, pair.other), from(pair.other, pair.one));
  }

  void judge() {
    for (Waveform& waveform : experiment_menu(limits_)) {
      const double minutes = (waveform.duration_s() + rest_before_s) / 60;
      const bool done =
          std::find(options_.done.begin(), options_.done.end(), waveform.name) != options_.done.end();
      if (minutes > options_.most_minutes || done) continue;
      result_.menu.push_back({std::move(waveform), minutes, {}, 0});
    }
    for (JudgedWaveform& judged : result_.menu) {
      judged.separations.resize(pairs_.size());
      for (std::size_t p = 0; p < pairs_.size(); ++p) {
        const Contest& contest = contests_[pairs_[p].contest];
        judged.separations[p] = {contest.ids[pairs_[p].one], contest.ids[pairs_[p].other], 0};
      }
    }
    separate(result_.menu.size(), Way::linear);
    rank();
    separate(std::min(confirmed, result_.menu.size()), Way::refitted);
    rank();
  }

  /// Computes the separations of causes for the first `count` waveforms in `menu`.
  /// @param way  linear approximation or nonlinear refit. A separation from a refit replaces the linear
  /// separation only if it is smaller.
  void separate(std::size_t count, Way way) {
    parallel_for(count * pairs_.size(), options_.threads, [&](std::size_t job) {
      JudgedWaveform& judged = result_.menu[job / pairs_.size()];
      Separation& separation = judged.separations[job % pairs_.size()];
      const double sigma = distance(record_of(judged.waveform), pairs_[job % pairs_.size()], way);
      separation.sigma = way == Way::linear ? sigma : std::min(separation.sigma, sigma);
    });
  }

  /// Ranks the waveforms by the squared separation per minute. This measure is used because the squared
  /// separations of repeated experiments add up.
  void rank() {
    for (JudgedWaveform& judged : result_.menu) {
      double learnt = 0;
      for (const Separation& s : judged.separations) {
        const double useful = std::min(s.sigma, certain_sigma);
        learnt += s.sigma < separation_needed_sigma ? 0 : useful * useful;
      }
      judged.merit = learnt / judged.minutes;
    }
    std::stable_sort(result_.menu.begin(), result_.menu.end(),
                     [](const JudgedWaveform& a, const JudgedWaveform& b) { return a.merit > b.merit; });
  }

  void choose() {
    if (result_.menu.empty() || result_.menu.front().merit <= 0) return;
    result_.best = result_.menu.front();
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::string>& ids = result_.separates;
    for (const Separation& s : result_.best->separations) {
      if (s.sigma < separation_needed_sigma) continue;
      least = std::min(least, s.sigma);
      for (const std::string& id : {s.one, s.other}) {
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
      }
    }
    result_.predicted_separation_sigma = least;
  }

  /// Returns true if no waveform can separate the two causes, but a check of the sensor against a gauge can.
  [[nodiscard]] bool asks_for_gauge(const Pair& pair, const AdviceFacts& facts) const {
    const auto one = find_cause(contests_[pair.contest].ids[pair.one]);
    const auto other = find_cause(contests_[pair.contest].ids[pair.other]);
    return !facts.separable && one && other && gauge_tells_apart(*one, *other);
  }

  void propose_gauge_check(std::vector<std::string> separates) {
    const GaugeScales scales = gauge_scales(d_.records, d_.noise_mm);
    ProposedGaugeCheck check;
    check.positions_mm =
        planned_positions(scales.highest_mm > -scales.lowest_mm ? scales.highest_mm : scales.lowest_mm);
    if (check.positions_mm.empty()) return;
    check.separates = std::move(separates);
    check.minutes = minutes_for(check.positions_mm.size());
    check.output_unit = d_.records.front().output_unit;
    result_.advice.push_back(
        model::in_unit(gauge_advice(check.positions_mm, check.separates), check.output_unit));
    result_.gauge_check = std::move(check);
  }

  void advise() {
    std::vector<std::string> by_gauge;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      double furthest = 0;
      for (const JudgedWaveform& judged : result_.menu)
        furthest = std::max(furthest, judged.separations[p].sigma);
      const Contest& contest = contests_[pairs_[p].contest];
      const AdviceFacts facts{options_.pressure_recorded, data_.scales.has_temperature,
                              furthest >= separation_needed_sigma, d_.gauge.has_value(),
                              !options_.limits || options_.limits->pressure_max_kpa > 0};
      if (asks_for_gauge(pairs_[p], facts) && !facts.gauge_made) {
        for (const std::string& id : {contest.ids[pairs_[p].one], contest.ids[pairs_[p].other]}) {
          if (std::find(by_gauge.begin(), by_gauge.end(), id) == by_gauge.end()) by_gauge.push_back(id);
        }
        continue;
      }
      for (std::string& sentence :
           advice_for(contest.ids[pairs_[p].one], contest.ids[pairs_[p].other], facts)) {
        if (std::find(result_.advice.begin(), result_.advice.end(), sentence) == result_.advice.end())
          result_.advice.push_back(std::move(sentence));
      }
    }
    if (!by_gauge.empty()) propose_gauge_check(std::move(by_gauge));
  }

  const Diagnosis& d_;
  const ExperimentOptions& options_;
  NoiseModel noise_;
  SearchData data_;
  RigLimits limits_;
  std::vector<Contest> contests_;
  std::vector<Pair> pairs_;
  NextExperiment result_;
};

}  // namespace

NextExperiment design_experiment(const Diagnosis& diagnosis, const ExperimentOptions& options) {
  return Designer(diagnosis, options).run();
}

}  // namespace softgrip::sysid
