#include "sysid/changes/change_judge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/changes/base_prediction.h"
#include "sysid/changes/causes_without_block.h"
#include "sysid/changes/change_claim.h"
#include "sysid/changes/change_search.h"
#include "sysid/changes/change_size.h"
#include "sysid/changes/change_warnings.h"
#include "sysid/changes/filter_fit.h"
#include "sysid/changes/healthy_runs.h"
#include "sysid/changes/later_readings.h"
#include "sysid/diagnosis/causes/ageing.h"
#include "sysid/diagnosis/causes/thermal_gain.h"
#include "sysid/evidence/veto.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t most_causes = 3;
constexpr auto* reason_for_no_search =
    "the error of the later logs is within the error permitted for a further healthy run";

constexpr auto* explains_less_than_half = "it explains less than half of the error of the change";

double rms_about_mean(const std::vector<double>& series) {
  PairSums sums;
  for (const double v : series) sums.add(v, v);
  return sums.count > 0 ? std::sqrt(std::max(0.0, sums.variance_x())) / sums.count : 0;
}

/// Returns true if the gain of the later logs differs from the healthy gain by more than the gains of two
/// runs of a finger usually differ.
bool has_unusual_gain(const JudgedChange& judged) {
  return std::abs(judged.gain_percent) > 100 * usual_gain_difference;
}

/// Returns true if the measured pressure has changed, with or without a known cause.
bool has_changed_pressure(const ChangeDiagnosis& diagnosis) {
  const auto is_of_pressure = [](const ChangeCause& cause) { return cause.judged == Judged::pressure; };
  const auto is_left = [](const JudgedChange& j) { return j.judged == Judged::pressure && j.left_over; };
  return std::any_of(diagnosis.causes.begin(), diagnosis.causes.end(), is_of_pressure) ||
         std::any_of(diagnosis.readings.begin(), diagnosis.readings.end(), is_left);
}

/// Evaluates one quantity, the displacement or the pressure. Computes the spread of the healthy records and
/// finds the causes of a change in the later records.
class Judge {
 public:
  Judge(Base base, const ChangeOptions& options, bool pressure_is_judged)
      : base_(std::move(base)), options_(options), pressure_is_judged_(pressure_is_judged) {}

  void judge(std::vector<Record> later, ChangeDiagnosis& diagnosis) {
    const Disagreement more = added_disagreement(base_, later);
    learn_temperature();
    say("search for changes in each left-out healthy run");
    healthy_ = healthy_fits(base_, pressure_is_judged_, options_.threads);
    spread_ = RunSpread(healthy_, base_.units.runs(), more);
    const Tolerance tolerance = tolerance_of(healthy_, base_.units.runs(), more.loss);
    std::vector<std::vector<double>> residuals = residuals_of(base_, later);
    double unevaluated_share = 0;
    if (base_.judged == Judged::pressure) {
      unevaluated_share = remove_unfamiliar_commands(base_, later, residuals);
      if (unevaluated_share > 1 - limits::probability)
        diagnosis.warnings.push_back(unfamiliar_commands(unevaluated_share));
    }
    const AlignedLines aligned = aligned_lines(later, residuals);
    set_oscillation_shifts(later, aligned.shifts_s);
    const LaterReadings readings = readings_of(base_, later, residuals);
    const std::vector<Effect> effects = effects_for(base_, later, aligned.lines, pressure_is_judged_);
    JudgedChange judged;
    judged.judged = base_.judged;
    judged.base = base_.description;
    judged.healthy_runs = base_.units.runs();
    judged.noise_mm = base_.noise_mm;
    judged.interval_contains = contained_in_intervals(base_, later.size());
    judged.healthy_mm = spread_.usual_rms();
    judged.allowed_mm = spread_.allowed_rms();
    judged.input_factor = spread_.input_factor();
    judged.unevaluated_share = unevaluated_share;
    if (judged.input_factor > limits::unfamiliar_factor)
      diagnosis.warnings.push_back(unfamiliar_input(judged.input_factor));
    const std::vector<std::string> other_starts = readings.other_starts();
    for (const std::string& name : other_starts) diagnosis.warnings.push_back(other_start(name));
    const bool has_another_input = base_.judged == Judged::displacement && has_changed_pressure(diagnosis);
    std::vector<Base> left_out_base;
    std::vector<LaterReadings> left_out;
    std::vector<FittedEffect> found;
    Eigen::VectorXd white = readings.white(found);
    judged.loss_before = judged.loss_left = per_bin(readings, white);
    for (std::size_t step = 0; step < most_causes; ++step) {
      // The search for a further cause continues only if the remaining error exceeds the error that is
      // expected in a further healthy run. For the first cause, a smaller error may be sufficient
      // (admits_a_change()), unless the pressure has changed: it is the input of the model of the
      // displacement, and the model was not fitted to such an input.
      const double rms = readings.plain_rms(found);
      const bool is_comparable = step == 0 && other_starts.empty() && !has_another_input;
      const bool is_large = is_comparable ? spread_.admits_a_change(rms, judged.loss_left)
                                          : spread_.is_exceeded(rms, judged.loss_left);
      // The first search also runs for a small error, because the result lists all tested causes.
      if (step > 0 && !is_large) break;
      say("search for changes in the later logs");
      std::vector<ScoredEffect> ranked =
          ranked_effects(readings, effects, found, tolerance, options_.threads);
      if (step == 0) {
        for (const ScoredEffect& each : ranked)
          judged.tried.push_back({each.fit.fitted.effect.id, each.fit.fitted.effect.form, each.gain,
                                  each.usual, each.tolerance, is_large ? "" : reason_for_no_search});
      }
      if (!is_large) break;
      if (step == 0) {
        left_out_base = left_out_bases(base_);
        left_out = left_out_readings(left_out_base, later, residuals);
      }
      const std::optional<ChangeCause> cause = first_change(
          {readings, found, white, healthy_, spread_, options_.seed, left_out}, std::move(ranked), judged);
      if (!cause) break;
      diagnosis.causes.push_back(*cause);
      found.push_back(cause->fitted);
      white = readings.white(found);
      judged.loss_left = per_bin(readings, white);
    }
    reject_listed(diagnosis.causes, "", judged);
    add_sizes(readings, left_out, found, diagnosis.causes);
    finish(readings, effects, found, judged);
    if (!found.empty() && judged.unusual_log.empty() && share_explained(judged) < limits::majority_share)
      leave_unnamed(diagnosis, judged);
    if (base_.judged == Judged::displacement && found.empty() && has_unusual_gain(judged))
      diagnosis.warnings.push_back(unusual_gain(
          judged.gain_percent,
          std::abs(judged.gain_percent) > 100 * (1 - limits::negligible_share) * base_.free_gain));
    if (base_.judged == Judged::displacement && found.empty() && base_.units.are_runs() &&
        is_another_zero(base_.zero_mm + judged.zero_mm))
      diagnosis.warnings.push_back(
          unusual_zero(judged.zero_mm, base_.zero_spread_mm, model::name_of(later.front().output_unit)));
    if (!judged.unusual_log.empty()) diagnosis.warnings.push_back(unusual_log(judged.unusual_log));
    diagnosis.readings.push_back(std::move(judged));
  }

 private:
  void say(const std::string& text) const {
    if (options_.progress) options_.progress(text);
  }

  /// Adds a temperature coefficient of the gain to the baseline model if the healthy logs show a dependence
  /// on the temperature. This dependence is a property of the healthy finger and not a change.
  void learn_temperature() {
    std::vector<Effect> effects = effects_for(base_, base_.records, {}, pressure_is_judged_);
    std::erase_if(effects, [](const Effect& e) { return e.id != causes::ThermalGain::id; });
    if (effects.empty()) return;
    const LaterReadings healthy = healthy_readings(base_);
    const std::vector<ScoredEffect> ranked = ranked_effects(healthy, effects, {}, {}, options_.threads);
    if (!(ranked.front().gain > limits::form_error_share)) return;
    FittedEffect own = ranked.front().fit.fitted;
    own.numbers.back() = 0;  // the baseline model already contains the gain at the mean temperature
    base_.left = minus(std::move(base_.left), healthy.added({own}));
    base_.gain_per_c = own.numbers.front();
  }

  /// Replaces the reasons for a rejection of the causes that are named or listed as alternatives. Each search
  /// tries all causes, so a cause can be rejected before or after the search that names it.
  void reject_listed(std::span<const ChangeCause> causes, std::string_view reason,
                     JudgedChange& judged) const {
    for (const ChangeCause& cause : causes) {
      for (TriedCause& tried : judged.tried) {
        if (cause.judged == base_.judged && cause.lists(tried.id)) tried.rejected = reason;
      }
    }
  }

  /// Returns the cause of the effect with the largest error reduction. The effect must meet all conditions of
  /// sysid/evidence/veto.h, and its error reduction must exceed its tolerance. Returns nullopt if no effect
  /// qualifies. Stores the reasons why other effects were rejected.
  [[nodiscard]] std::optional<ChangeCause> first_change(const CauseSearch& search,
                                                        std::vector<ScoredEffect> ranked,
                                                        JudgedChange& judged) const {
    const LaterReadings& readings = search.readings;
    const std::vector<FittedEffect>& found = search.found;
    // The table of tested causes shows the numbers of the first search. If a later search rejects a cause,
    // the reason therefore names the causes that were found before this search.
    std::string given;
    for (const FittedEffect& each : found) given += (given.empty() ? "with " : " and ") + each.effect.id;
    if (!given.empty()) given += ", ";
    const auto reject = [&](const ScoredEffect& scored, std::string_view reason) {
      for (TriedCause& tried : judged.tried) {
        if (tried.id == scored.fit.fitted.effect.id && tried.rejected.empty())
          tried.rejected = given + std::string(reason);
      }
    };
    const std::string_view not_larger =
        found.empty() ? "the probability that the error reduction exceeds the tolerance is below 95 %"
                      : "the probability that a further error reduction exceeds the tolerance is below 95 %";
    const std::vector<ScoredEffect> all = ranked;
    std::erase_if(ranked, [&](const ScoredEffect& each) {
      const Comparison against_none =
          compare(paired_losses(readings, search.without, each.fit.white),
                  each.tolerance + price_per_row(readings, each.fit.fitted.effect), options_.seed);
      if (is_better(against_none)) return false;
      reject(each, not_larger);
      return true;
    });
    const Ties ties = ties_in(readings, options_.seed);
    for (; !ranked.empty(); ranked.erase(ranked.begin())) {
      put_fewest_numbers_first(ranked, ties);
      const Veto veto = vetoed(search, ranked.front());
      if (veto == Veto::none) return cause_of(search, ranked.front(), all, ties, judged);
      reject(ranked.front(), reason_of(veto));
    }
    return std::nullopt;
  }

  /// Returns true if the zero offset of the later logs [mm] differs significantly from the mean zero offset
  /// of the healthy runs. A difference is significant if a healthy run would exceed it in less than 5 % of
  /// the cases.
  [[nodiscard]] bool is_another_zero(double zero_mm) const {
    const auto units = static_cast<double>(base_.units.count());
    return std::abs(zero_mm - base_.zero_mm) >
           t_quantile(units - 1) * base_.zero_spread_mm * std::sqrt(1 + 1 / units);
  }

  /// @param all  all effects, sorted by their error reductions. An alternative need not exceed its tolerance,
  /// because the change has already been detected. If the logs lack the situation in which an alternative
  /// must act, they cannot exclude it.
  [[nodiscard]] ChangeCause cause_of(const CauseSearch& search, const ScoredEffect& scored,
                                     const std::vector<ScoredEffect>& all, const Ties& ties,
                                     JudgedChange& judged) const {
    const LaterReadings& readings = search.readings;
    const FittedEffect best =
        with_whole_gain(readings, scored.fit.fitted, readings.nuisance(search.with(scored.fit.fitted)).gain);
    const Binned added = readings.added({best});
    ChangeCause cause;
    cause.id = best.effect.id;
    cause.title = best.effect.title;
    cause.station = best.effect.station;
    cause.judged = base_.judged;
    cause.fitted = best;
    cause.gain = scored.gain;
    const PairedLosses losses = paired_losses(readings, search.without, scored.fit.white);
    const Comparison spread = compare(losses, 0, options_.seed);
    cause.gain_interval = Interval{spread.lower, spread.upper};
    cause.reduction = error_reduction(losses, options_.seed);
    std::vector<const ScoredEffect*> others;
    for (const ScoredEffect& other : all) {
      if (other.fit.fitted.effect.id != cause.id && is_alternative(search, scored, other, ties))
        others.push_back(&other);
    }
    std::vector<Veto> vetoes(others.size());
    parallel_for(others.size(), options_.threads,
                 [&](std::size_t i) { vetoes[i] = vetoed(search, *others[i]); });
    for (std::size_t i = 0; i < others.size() && cause.alternatives.size() < limits::most_alternatives; ++i) {
      const Effect& effect = others[i]->fit.fitted.effect;
      if (vetoes[i] == Veto::not_tested) judged.not_tested.emplace(effect.id, recording_for(effect.appears));
      if (vetoes[i] == Veto::none || vetoes[i] == Veto::not_tested) cause.alternatives.push_back(effect.id);
    }
    if (cause.lists(causes::Ageing::WithTime::id) && !cause.lists(payload.id) &&
        is_another_zero(readings.nuisance(search.with(best)).zero_mm))
      cause.alternatives.emplace_back(payload.id);
    cause.effect_mm = rms_of(added);
    cause.full_pressure_mm = at_full_pressure(readings, added);
    const double excess = per_bin(readings, search.without) - 1;
    cause.share_percent = excess > 0 ? std::clamp(100 * cause.gain / excess, 0.0, 100.0) : 0;
    return cause;
  }

  /// Adds the sizes and the intervals to the causes in this quantity.
  /// @param found  effects of these causes, in the same order.
  void add_sizes(const LaterReadings& readings, std::span<const LaterReadings> left_out,
                 const std::vector<FittedEffect>& found, std::vector<ChangeCause>& causes) const {
    const std::vector<EffectIntervals> intervals = intervals_of(readings, found, healthy_, left_out);
    auto next = intervals.begin();
    for (ChangeCause& cause : causes) {
      if (cause.judged != base_.judged || cause.fitted.effect.id.empty()) continue;
      const ShownSize shown = shown_size(readings, cause.fitted, *next);
      cause.size = shown.size;
      cause.intervals = *next++;
      cause.intervals.size = shown.interval;
    }
  }

  /// Returns the name of the record without which the error of the other later records is within the errors
  /// of healthy runs. If there is only one record or no such record, returns an empty text. The run is the
  /// unit of the evidence, so a single run does not show a change that the other later runs do not show.
  [[nodiscard]] std::string decisive_record(const LaterReadings& readings,
                                            const std::vector<FittedEffect>& found) const {
    const std::vector<Record>& records = readings.records();
    for (std::size_t r = 0; r < records.size() && records.size() > 1; ++r) {
      const LaterReadings others = readings.without_record(r);
      if (!spread_.is_exceeded(others.plain_rms(found), per_bin(others, others.white(found))))
        return records[r].name;
    }
    return {};
  }

  /// Moves the causes of this quantity to the partial causes.
  void leave_unnamed(ChangeDiagnosis& diagnosis, JudgedChange& judged) const {
    const auto named = std::stable_partition(
        diagnosis.causes.begin(), diagnosis.causes.end(), [&](const ChangeCause& cause) {
          return cause.judged != base_.judged || cause.fitted.effect.id.empty();
        });
    reject_listed({named, diagnosis.causes.end()}, explains_less_than_half, judged);
    std::move(named, diagnosis.causes.end(), std::back_inserter(diagnosis.partial));
    diagnosis.causes.erase(named, diagnosis.causes.end());
    judged.left_over = true;
  }

  void finish(const LaterReadings& readings, const std::vector<Effect>& effects,
              const std::vector<FittedEffect>& found, JudgedChange& judged) const {
    judged.later_mm = readings.plain_rms({});
    judged.explained_mm = found.empty() ? judged.later_mm : readings.plain_rms(found);
    if (spread_.is_exceeded(judged.explained_mm, judged.loss_left)) {
      judged.unusual_log = decisive_record(readings, found);
      judged.left_over = judged.unusual_log.empty();
    }
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
    judged.zero_mm = nuisance.zero_mm - base_.zero_mm;
    judged.gain_percent = 100 * nuisance.gain;
    for (const Effect& effect : effects) {
      if (!is_met(required_rows(readings, effect.appears)))
        judged.not_tested.emplace(effect.id, recording_for(effect.appears));
    }
    for (TriedCause& tried : judged.tried) {
      if (judged.not_tested.contains(tried.id)) tried.rejected = reason_of(Veto::not_tested);
    }
  }

  Base base_;
  const ChangeOptions& options_;
  bool pressure_is_judged_;
  std::vector<HealthyFits> healthy_;
  RunSpread spread_;
};

}  // namespace

void judge_change(Base base, bool pressure_is_judged, const std::vector<Record>& later,
                  const ChangeOptions& options, ChangeDiagnosis& diagnosis) {
  Judge(std::move(base), options, pressure_is_judged).judge(later, diagnosis);
}

}  // namespace softgrip::sysid
