#include "sysid/diagnosis/verdict/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "base/enumerated.h"
#include "base/numbers.h"
#include "base/statistics.h"
#include "base/thread_budget.h"
#include "sysid/diagnosis/causes/clock_offset.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/residual/unexplained_limit.h"
#include "sysid/diagnosis/search/coherence.h"
#include "sysid/diagnosis/search/linear_holdout.h"
#include "sysid/diagnosis/search/stick_slip_selection.h"
#include "sysid/diagnosis/verdict/another_base.h"
#include "sysid/diagnosis/verdict/base_ingredients.h"
#include "sysid/diagnosis/verdict/data_warnings.h"
#include "sysid/diagnosis/verdict/dense_logs.h"
#include "sysid/diagnosis/verdict/mixed_intervals.h"
#include "sysid/diagnosis/verdict/naming.h"
#include "sysid/diagnosis/verdict/untested_causes.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr double clearly_correlated = 0.05;
constexpr std::size_t fewest_samples = 200;
/// Refits the base structure. The given model may be far from the data, so the fits start at the given model
/// and at points at the scale of the data.
tl::expected<StructureFit, std::string> recalibrate(const SearchData& data, const DiagnosisOptions& options) {
  StructureFit best = fit_structure(data.records, {}, data.given);
  IdentifyOptions wide;
  wide.starts = 6;
  wide.seed = options.seed;
  wide.threads = options.threads;
  wide.record = options.record;
  auto found = identify(data.records, data.given.model, wide);
  if (found) {
    FitPoint point{found->fitted, rest_starts(found->fitted, data.records)};
    // The initial states of the records are the states that the identification estimated.
    for (std::size_t k = 0; k < data.records.size(); ++k) point.starts[k] = found->scores[k].start;
    StructureFit other = fit_structure(data.records, {}, point);
    if (other.mean_square_mm2 < best.mean_square_mm2 * (1 - 1e-4)) best = std::move(other);
  }
  if (!std::isfinite(best.mean_square_mm2))
    return Failure("the prediction of these logs by the model is not finite");
  return best;
}

/// Returns the RMSE of each run. If there is a single run, returns the RMSE of each half.
std::vector<RunError> run_errors(const std::vector<Record>& records, const Division& by_unit,
                                 const BlockLosses& given, const BlockLosses& recalibrated,
                                 const BlockLosses& extended) {
  const bool are_runs = records.size() > 1;
  std::vector<RunError> runs(are_runs ? records.size() : by_unit.folds);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    runs[k].run = are_runs ? records[k].name : k == 0 ? "first half" : "second half";
    BlockLosses own_given, own_recalibrated, own_extended;
    for (std::size_t b = 0; b < by_unit.blocks.size(); ++b) {
      const Block& block = by_unit.blocks[b];
      const auto readings = records[block.record].reading_mm.begin();
      const auto begin = readings + static_cast<std::ptrdiff_t>(block.first);
      const auto end = readings + static_cast<std::ptrdiff_t>(block.last);
      if ((are_runs ? block.record : block.fold) != k ||
          std::none_of(begin, end, [](double y) { return std::isfinite(y); }))
        continue;
      own_given.push_back(given[b]);
      own_recalibrated.push_back(recalibrated[b]);
      own_extended.push_back(extended[b]);
    }
    runs[k].given = rmse_mm(own_given);
    runs[k].recalibrated = rmse_mm(own_recalibrated);
    runs[k].extended = rmse_mm(own_extended);
  }
  return runs;
}

class Diagnostician {
 public:
  Diagnostician(const std::vector<Log>& logs, const model::Model& given, const DiagnosisOptions& options)
      : logs_(logs), given_(given), options_(options) {}

  tl::expected<Diagnosis, std::string> run() {
    if (auto done = judge_displacement(); !done) return Failure(done.error());
    correct_by_logs(d_, logs_);
    if (d_.in_valve) take_out_named(*d_.in_valve);
    return std::move(d_);
  }

 private:
  tl::expected<void, std::string> judge_displacement() {
    StageClock clock(d_);
    if (options_.progress) options_.progress("recalibration");
    if (auto ready = prepare(); !ready) return Failure(ready.error());
    auto base = recalibrate(data_, options_);
    if (!base) return Failure(base.error());
    hide_more_outliers(*base);
    const Division division = divide(data_.records, block_length_s);
    d_.recalibrated = std::move(*base);
    if (const auto wrong = why_not_about(data_.records, d_.recalibrated)) return Failure(*wrong);
    clock.ended("recalibration");
    if (options_.progress) options_.progress("identification of the valve");
    d_.in_valve =
        find_in_valve(logs_, {given_, options_.record.held, d_.noise_mm, options_.seed, options_.threads});
    if (d_.in_valve) {
      if (!d_.in_valve->advice.empty()) d_.warnings.push_back(d_.in_valve->advice);
      clock.ended("valve");
    }
    const BaseQuestion about_base{options_.record.drive, d_.noise_mm, options_.seed,
                                  options_.threads,      division,    options_.progress};
    std::optional<AnotherBase> asked(std::in_place, data_, about_base);
    Selection selection = search(d_.recalibrated, division, *asked);
    if (open_starts(selection, division)) {
      asked.emplace(data_, about_base);
      selection = search(d_.recalibrated, division, *asked);
    }
    if (shift_drive(selection, division)) {
      asked.emplace(data_, about_base);
      selection = search(d_.recalibrated, division, *asked);
    }
    AnotherBase& another = *asked;
    clock.ended("search");
    if (leaves_too_much(selection) || (another.is_found() && selection.left.present)) {
      if (may_ask_at_once()) look_for_base(another, selection);
      clock.ended("base");
      if (!another.settles(selection) && look_for_stick_slip(selection, division)) {
        another.drop();
        clock.ended("staircase");
      }
    } else {
      another.drop();  // the selection with a second cause explains the data
    }
    if (another.is_found()) {
      measure_recalibrated(selection);
      adopt(another.found(), selection);
      clock.ended("held-out logs and intervals");
      return {};
    }
    if (options_.gauge) {
      const GaugeQuestion question{*options_.gauge, d_.noise_mm, options_.seed, !d_.stick_slip};
      d_.gauge = weigh_gauge(question, data_, division, selection, d_.warnings);
      if (d_.gauge->replaced) selection.undecided = fit_confounded(data_, selection.extended, division);
      clock.ended("gauge");
    }
    measure(selection, division);
    if (options_.null_campaigns > 0 && !selection.chosen.empty()) calibrate(division);
    if (d_.null_calibration) clock.ended("nulls");
    name(selection);
    another.add_alternatives(causes_);
    conclude(selection);
    clock.ended("held-out logs and intervals");
    if (options_.gauge && options_.null_campaigns == 0 && d_.verdict == Verdict::unexplained) {
      look_for_base(another, selection);
      if (another.is_found()) adopt(another.found(), selection);
      clock.ended("base");
    }
    return {};
  }

  /// Removes the valve causes that were already found in the displacement.
  void take_out_named(ValveFindings& in_valve) {
    std::erase_if(in_valve.named, [&](const NamedCause& one) { return is_among(d_.causes, one.cause); });
  }

  tl::expected<void, std::string> prepare() {
    std::vector<Record> records = make_records(logs_, options_.record);
    std::size_t readings = 0;
    for (const Record& record : records) readings += record.readings;
    if (readings < fewest_samples) {
      return Failure("only " + std::to_string(readings) +
                     " readings in total: too few to separate a cause from noise (" +
                     std::to_string(fewest_samples) + " are needed)");
    }
    // The zero offset of the first log is arbitrary. If the zero offset changes from log to log, the sensor
    // drifts, and drift is a possible cause.
    const bool zero_free = records.front().offset_free && !records.front().start_unknown;
    for (Record& record : records) record.offset_free = zero_free || record.start_unknown;
    d_.sampling = hide_repeated(records);
    d_.noise_mm = measured_noise_mm(records);
    if (d_.noise_mm <= 0) return Failure("the readings have no noise, so they cannot be measured data");
    d_.outliers = hide_outliers(records, d_.noise_mm);
    if (average_dense(records, d_.warnings)) d_.noise_mm = measured_noise_mm(records);
    use(std::move(records));
    warn_of_data(logs_, data_.scales, d_.warnings);
    warn_of_scale(d_.records, d_.as_given.residual_mm, d_.warnings);
    return {};
  }

  void use(std::vector<Record> records) {
    data_ = make_search_data(std::move(records), deterministic_part(given_, options_.record.drive));
    data_.threads = options_.threads;
    data_.scales.has_valve = options_.record.drive == Drive::command;
    d_.records = data_.records;
    d_.as_given = evaluate_structure(data_.records, {},
                                     {data_.given.model, estimated_starts(data_.given.model, data_.records)});
    d_.as_given_rmse_mm = std::sqrt(d_.as_given.mean_square_mm2);
  }

  /// Hides outliers in a motion, which can be found only from the residual of the refitted model. The fit
  /// without these outliers is more accurate and may show other outliers, so the search is repeated.
  void hide_more_outliers(StructureFit& base) {
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<Record> records = data_.records;
      if (hide_outliers_beside(records, base.residual_mm, d_.noise_mm, d_.outliers) == 0) return;
      use(std::move(records));
      base = fit_structure(data_.records, {}, base.point);
    }
  }

  /// Handles logs that begin without pressure before the finger has settled. The given structure is fitted
  /// with estimated initial states. If this fit explains the logs better than all causes found, it replaces
  /// the recalibrated model, and the result is true.
  bool open_starts(const Selection& selection, const Division& division) {
    const auto is_given = [](const Record& r) { return r.start != Start::automatic || r.start_unknown; };
    if (!selection.left.present || std::all_of(data_.records.begin(), data_.records.end(), is_given))
      return false;
    std::vector<Record> open = data_.records;
    for (Record& record : open) record.start_unknown |= !is_given(record);
    const auto fitted_from = [&](const model::Model& model) {
      return fit_structure(open, {}, {model, rest_starts(model, open)});
    };
    StructureFit fit = fitted_from(selection.base.point.model);
    StructureFit from_given = fitted_from(data_.given.model);
    if (from_given.mean_square_mm2 < fit.mean_square_mm2) fit = std::move(from_given);
    if (!is_missed(selection.extended_losses, held_out_losses(open, division, fit),
                   0.01 * square(d_.noise_mm), options_.seed))
      return false;
    // Creep that never settles can compensate for any difference between the logs of two rigs.
    if (inconsistent_among(data_.records, selection.base, fit.mean_square_mm2)) return false;
    use(std::move(open));
    d_.recalibrated = std::move(fit);
    d_.warnings.emplace_back(
        "The logs begin without pressure, but the finger is still moving. The initial state of each log is "
        "therefore estimated. This estimate may hide a slow change at the beginning of the log");
    return true;
  }

  /// Corrects the error reduction if the drive was shifted, so that the reduction includes the shift. The
  /// errors of the given and the refitted model are then those with the original drive.
  void count_shift(const BlockLosses& extended) {
    if (!d_.lead) return;
    d_.as_given_rmse_mm = unshifted_.as_given_rmse_mm;
    d_.recalibrated_rmse_mm = rmse_mm(unshifted_.recalibrated);
    d_.gain = gain_percent(unshifted_.recalibrated, extended, options_.seed);
  }

  /// Shifts the drive if the readings react before the command changes. Returns true if the search must be
  /// repeated.
  bool shift_drive(const Selection& selection, const Division& division) {
    std::optional<LeadFit> shifted = fit_lead(data_, selection, d_.noise_mm);
    if (!shifted) return false;
    const BlockLosses losses = held_out_losses(shifted->records, division, shifted->fit);
    if (!is_missed(selection.base_losses, losses, 0.01 * square(d_.noise_mm), options_.seed)) return false;
    unshifted_ = Unshifted{d_.as_given_rmse_mm, selection.base_losses, losses};
    use(std::move(shifted->records));
    d_.recalibrated = std::move(shifted->fit);
    d_.lead = shifted->lead;
    return true;
  }

  /// Returns true if the selection leaves too large an error. The limit is the error that its causes may
  /// leave. If the selection contains no causes, the limit is the noise.
  [[nodiscard]] bool leaves_too_much(const Selection& selection) const {
    if (!selection.left.present) return false;
    if (selection.extended.causes.empty()) {
      return !left_by_outliers(selection.left) && selection.left.excess_mm > worth_a_look * d_.noise_mm;
    }
    return sysid::leaves_too_much(selection.left, selection.base_unexplained, d_.noise_mm);
  }

  /// Searches for stick-slip of the valve. No simulation from the command alone can predict its effect.
  /// Returns true if stick-slip was the missing effect. `selection` then contains the causes that were found
  /// with the positions of the valve as input.
  bool look_for_stick_slip(Selection& selection, const Division& division) {
    if (options_.record.drive != Drive::command) return false;
    if (options_.progress) options_.progress("search for stick-slip");
    SelectionOptions one_more;
    one_more.most_causes = 1;
    one_more.seed = options_.seed;
    one_more.progress = options_.progress;
    auto found = select_behind_stick_slip(data_, selection, d_.noise_mm, division, one_more);
    if (!found || leaves_too_much(found->selection)) return false;
    // A path of many small steps can fit any residual. Stick-slip is therefore accepted only if it explains
    // at least 75 % of the remaining mean square.
    if (square(found->selection.left.excess_mm) > left_by_what_was_missing * square(selection.left.excess_mm))
      return false;
    selection = std::move(found->selection);
    d_.stick_slip = found->evidence;
    return true;
  }

  /// Returns true if the search for another base structure may begin at once. If there are gauge readings or
  /// null campaigns, they must test the selection before.
  [[nodiscard]] bool may_ask_at_once() const { return !options_.gauge && options_.null_campaigns == 0; }

  void look_for_base(AnotherBase& another, const Selection& selection) {
    ask_for_base(another, selection);
    another.go_on(selection);
  }

  void ask_for_base(AnotherBase& another, const Selection& selection) {
    if (auto inconsistent = another.ask(selection, d_.recalibrated)) d_.warnings.push_back(*inconsistent);
  }

  Selection search(StructureFit recalibrated, const Division& division, AnotherBase& another) {
    data_.scales.residual_lines = spectrum_peaks(data_.records, recalibrated.residual_mm);
    SelectionOptions options;
    options.seed = options_.seed;
    options.progress = options_.progress;
    std::optional<Selection> one_is_not_enough;
    if (left_by_outliers(unexplained_error_of(recalibrated.residual_mm, d_.noise_mm)))
      options.most_causes = 0;
    if (may_ask_at_once()) {
      options.one_cause_stands = [&](const Selection& one_cause) {
        if (may_lack_a_base(one_cause, d_.noise_mm)) one_is_not_enough = one_cause;
      };
      options.to_beat_mm2 = [&] {
        if (one_is_not_enough) ask_for_base(another, *one_is_not_enough);
        return another.mean_square_mm2();
      };
    }
    Selection selection = select_causes(data_, std::move(recalibrated), d_.noise_mm, division, options);
    if (one_is_not_enough && selection.left.present) ask_for_base(another, *one_is_not_enough);
    return selection;
  }

  void adopt(BaseFindings& base, const Selection& selection) {
    d_.base = base.description;
    d_.extended = std::move(base.fit);
    d_.extended_rmse_mm = rmse_mm(base.losses);
    d_.extended_other_logs_rmse_mm.reset();
    d_.recalibrated_other_logs_rmse_mm.reset();
    const Division by_unit = divide_by_unit(data_.records);
    d_.runs = run_errors(data_.records, by_unit, losses_of(d_.as_given, by_unit),
                         left_out_losses(data_.records, by_unit, selection.base),
                         linear_held_out_losses(data_.records, by_unit, d_.extended));
    d_.gain = gain_percent(selection.base_losses, base.losses, options_.seed);
    d_.unexplained_error = unexplained_error_of(d_.extended.residual_mm, d_.noise_mm);
    d_.unexplained_percent =
        std::min(100.0, 100 * square(d_.unexplained_error.excess_mm / selection.base_unexplained.excess_mm));
    count_shift(base.losses);
    d_.extended_model = named_model(d_.extended.point.model, "extended");
    d_.causes = std::move(base.named);
    std::vector<NamedCause> in_readings = found_in_readings();
    d_.causes.insert(d_.causes.begin(), std::make_move_iterator(in_readings.begin()),
                     std::make_move_iterator(in_readings.end()));
    d_.partial = std::move(base.possible);
    const bool whole = !sysid::leaves_too_much(d_.unexplained_error, selection.base_unexplained, d_.noise_mm);
    d_.verdict = d_.causes.empty()             ? Verdict::unexplained
                 : !whole                      ? Verdict::partly_explained
                 : any_alternatives(d_.causes) ? Verdict::ambiguous
                                               : Verdict::cause_found;
  }

  void measure_recalibrated(const Selection& selection) {
    d_.unexplained_recalibrated = selection.base_unexplained;
    d_.recalibrated_rmse_mm = rmse_mm(selection.base_losses);
    d_.rejected = selection.last_candidates;
    d_.recalibrated_model = named_model(selection.base.point.model, "recalibrated");
    warn_unphysical(d_.recalibrated_model, d_.warnings);
  }

  void measure(const Selection& selection, const Division& division) {
    measure_recalibrated(selection);
    d_.extended = selection.extended;
    d_.unexplained_error = selection.left;
    d_.extended_rmse_mm = rmse_mm(selection.extended_losses);
    d_.gain = gain_percent(selection.base_losses, selection.extended_losses, options_.seed);
    // The parameters of the refitted model are compared with the parameters of the given model. In both
    // models, the initial states are fitted.
    const StructureFit given = fit_starts(data_.records, {}, data_.given);
    recalibration_gain_ = mean_difference(losses_of(given, division), selection.base_losses, options_.seed);
    d_.unexplained_percent =
        selection.base_unexplained.excess_mm > 0
            ? std::min(100.0, 100 * square(selection.left.excess_mm / selection.base_unexplained.excess_mm))
            : 0;
    if (!selection.left.present && !selection.base_unexplained.present) d_.unexplained_percent = 0;
    const Division by_unit = divide_by_unit(data_.records);
    const BlockLosses recalibrated = left_out_losses(data_.records, by_unit, selection.base);
    const BlockLosses extended =
        selection.chosen.empty() ? recalibrated : left_out_losses(data_.records, by_unit, selection.extended);
    d_.runs = run_errors(data_.records, by_unit, losses_of(d_.as_given, by_unit), recalibrated, extended);
    if (data_.records.size() > 1) {
      d_.recalibrated_other_logs_rmse_mm = rmse_mm(recalibrated);
      if (!selection.chosen.empty()) d_.extended_other_logs_rmse_mm = rmse_mm(extended);
    }
    count_shift(selection.extended_losses);
    d_.extended_model = named_model(selection.extended.point.model,
                                    selection.extended.causes.empty() ? "recalibrated" : "extended");
  }

  void calibrate(const Division& division) {
    NullOptions nulls;
    nulls.campaigns = options_.null_campaigns;
    nulls.seed = options_.seed;
    if (options_.progress) {
      nulls.progress = [&](std::size_t done) {
        options_.progress("null campaign " + std::to_string(done) + " of " +
                          std::to_string(options_.null_campaigns));
      };
    }
    d_.null_calibration = calibrate_on_nulls(data_, d_.recalibrated, d_.gain.value, division, nulls);
  }

  /// Returns the model with a different name. If two models had the same name, files and figures would be
  /// ambiguous.
  [[nodiscard]] model::Model named_model(model::Model model, const std::string& how) const {
    // The daemon uses the command as input, so the blocks of the valve are inserted into the model.
    if (options_.record.drive == Drive::measured && d_.in_valve)
      model = with_valve(std::move(model), d_.in_valve->stage);
    model.name = given_.name + '_' + how.substr(0, how.find(' '));
    model.source =
        how + " by softgrip diagnose from " + with_commas(logs_, &Log::name) + "; before: " + given_.source;
    return model;
  }

  [[nodiscard]] std::vector<NamedCause> found_in_readings() const {
    std::vector<NamedCause> named =
        causes_in_readings(d_.outliers, d_.sampling, d_.noise_mm, d_.records.front().output_unit);
    if (d_.lead) {
      NamedCause lead;
      lead.cause = *find_cause(causes::ClockOffset::id);
      lead.block_type = lead.cause.forms.front().type;
      lead.parameters = {{"lead_s", "s", d_.lead->lead_s, d_.lead->ci95, true}};
      lead.heldout_gain_percent = gain_percent(unshifted_.recalibrated, unshifted_.shifted, options_.seed);
      lead.gain_mm2 = mean_difference(unshifted_.recalibrated, unshifted_.shifted, options_.seed);
      named.push_back(std::move(lead));
    }
    return named;
  }

  void name(const Selection& selection) {
    causes_ = found_in_readings();
    std::vector<NamedCause> chosen = name_chosen(data_.records, selection.extended, selection.chosen);
    if (!d_.stick_slip) {
      for (std::string& sentence : mix_intervals(chosen, data_.records, selection, options_.seed))
        d_.warnings.push_back(std::move(sentence));
    }
    for (NamedCause& named : chosen) {
      if (d_.stick_slip && named.cause.id == causes::ValveDeadband::id) {
        // The reported band is that of the stick-slip motion, because the extended model may contain the band
        // of the mean motion.
        named.parameters.front() = {"band_kpa", "kPa", d_.stick_slip->band_kpa, d_.stick_slip->band_ci95,
                                    true};
      }
      causes_.push_back(std::move(named));
    }
  }

  /// Returns true if the remaining error is due to wrong readings that were not found. Wrong readings are
  /// isolated. The effect of a cause, in contrast, is correlated from sample to sample.
  [[nodiscard]] bool left_by_outliers(const UnexplainedError& structure) const {
    return d_.outliers.present && structure.slow_correlation <= clearly_correlated &&
           structure.excess_mm < d_.noise_mm;
  }

  void conclude(const Selection& selection) {
    // If the gauge readings selected one of two indistinguishable causes, the remaining error of this cause
    // has no influence on the verdict.
    const bool placed_by_gauge = d_.gauge && d_.gauge->replaced;
    const bool too_much_left = !placed_by_gauge && leaves_too_much(selection);
    const bool by_chance = d_.null_calibration && d_.null_calibration->reach_the_gain();
    if (!selection.chosen.empty() && (too_much_left || by_chance)) {
      d_.verdict = Verdict::unexplained;
      d_.partial = std::move(causes_);
      d_.extended_model =
          by_chance ? d_.recalibrated_model : named_model(selection.extended.point.model, "extended in part");
      return;
    }
    if (selection.chosen.empty() && too_much_left) {
      d_.verdict = Verdict::unexplained;
      d_.partial = std::move(causes_);
      d_.unexplained_percent = 100;
      return;
    }
    d_.causes = std::move(causes_);
    if ((d_.outliers.present || d_.sampling.present) && selection.chosen.empty()) {
      const double left = square(selection.left.excess_mm);
      const double explained = (d_.outliers.present ? square(d_.outliers.excess_mm) : 0) +
                               (d_.sampling.present ? square(d_.sampling.excess_mm) : 0);
      d_.unexplained_percent = selection.left.present ? 100 * left / (left + explained) : 0;
    }
    if (!d_.causes.empty()) {
      d_.verdict = any_alternatives(d_.causes) ? Verdict::ambiguous : Verdict::cause_found;
      return;
    }
    const bool better =
        recalibration_gain_.lower > 0 && recalibration_gain_.value > 0.01 * square(d_.noise_mm);
    d_.verdict = better ? Verdict::recalibrate : Verdict::adequate;
  }

  const std::vector<Log>& logs_;
  const model::Model& given_;
  const DiagnosisOptions& options_;
  SearchData data_;
  /// Errors of the models with the original drive, and held-out losses with the shifted drive.
  struct Unshifted {
    double as_given_rmse_mm = 0;
    BlockLosses recalibrated, shifted;
  };
  Unshifted unshifted_;
  Spread recalibration_gain_;
  std::vector<NamedCause> causes_;
  Diagnosis d_;
};

}  // namespace

void examine(Diagnosis& d, const DiagnosisOptions& options) {
  StageClock clock(d);
  const ThreadBudget budget(options.threads);
  d.evidence = examine_fits(d.records, d.as_given, d.recalibrated, d.extended, d.noise_mm, options.seed);
  clock.ended("evidence");
}

tl::expected<Diagnosis, std::string> diagnose(const std::vector<Log>& logs, const model::Model& given,
                                              const DiagnosisOptions& options) {
  if (logs.empty()) return Failure("no logs to diagnose");
  const ThreadBudget budget(options.threads);
  return Diagnostician(logs, given, options).run();
}

}  // namespace softgrip::sysid
