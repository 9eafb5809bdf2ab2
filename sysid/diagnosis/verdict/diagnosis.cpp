#include "sysid/diagnosis/verdict/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "base/statistics.h"
#include "base/thread_budget.h"
#include "model/blocks/periodic_disturbance.h"
#include "model/blocks/quantisation.h"
#include "model/named.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/stick_slip.h"
#include "sysid/diagnosis/verdict/another_base.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/diagnosis/verdict/conclusion.h"
#include "sysid/diagnosis/verdict/data_warnings.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

using Failure = tl::unexpected<std::string>;

/// Returns true if the model contains a resolution that is nearly equal to `step_mm` or coarser.
bool states_resolution(const model::Model& model, double step_mm) {
  const auto place = model::position_of<model::Quantisation>(model);
  return place && model.blocks[*place].values.front() * limits::comparable_ratio >= step_mm;
}

/// Refits the base structure. The parameters of the given model may be far from the true ones, so some fits
/// start at points that are scaled to the data.
tl::expected<StructureFit, std::string> recalibrate(const SearchData& data, const DiagnosisOptions& options) {
  StructureFit best = fit_structure(data.records, {}, data.given);
  IdentifyOptions wide;
  wide.starts = limits::repeated_starts;
  wide.seed = options.seed;
  wide.threads = options.threads;
  wide.record = options.record;
  auto found = identify(data.records, data.given.model, wide);
  if (found) {
    FitPoint point{found->fitted, rest_starts(found->fitted, data.records)};
    // The initial states of the records are those that the identification has estimated.
    for (std::size_t k = 0; k < data.records.size(); ++k) point.starts[k] = found->scores[k].start;
    StructureFit other = fit_structure(data.records, {}, point);
    if (other.mean_square_mm2 < best.mean_square_mm2 * (1 - 1e-4)) best = std::move(other);
  }
  if (!std::isfinite(best.mean_square_mm2))
    return Failure("the prediction of these logs by the model is not finite");
  return best;
}

class Diagnostician {
 public:
  Diagnostician(const std::vector<Log>& logs, const model::Model& given, const DiagnosisOptions& options)
      : logs_(logs), given_(given), options_(options), conclusion_(logs, given, options, data_, d_) {}

  tl::expected<Diagnosis, std::string> run() {
    if (auto done = judge_displacement(); !done) return Failure(done.error());
    correct_by_logs(d_, logs_, [this] { return responses(); });
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
    const Division division = divide(data_.records, block_length_in_units * data_.scales.time_unit_s);
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
    if (conclusion_.leaves_too_much(selection) || (another.is_found() && selection.left.present)) {
      if (may_ask_at_once()) look_for_base(another, selection);
      clock.ended("base");
      if (!another.settles(selection) && look_for_stick_slip(selection, division)) {
        another.drop();
        clock.ended("staircase");
      }
    } else {
      another.drop();  // the selection with a second cause already explains the data
    }
    if (another.is_found()) {
      conclusion_.measure_recalibrated(selection);
      conclusion_.adopt(another.found(), selection);
      clock.ended("held-out logs and intervals");
      return {};
    }
    if (options_.gauge) {
      const GaugeQuestion question{*options_.gauge, d_.noise_mm, options_.seed, !d_.stick_slip};
      d_.gauge = weigh_gauge(question, data_, division, selection, d_.warnings);
      if (d_.gauge->replaced) selection.undecided = fit_confounded(data_, selection.extended, division);
      clock.ended("gauge");
    }
    conclusion_.measure(selection, division);
    if (options_.null_campaigns > 0 && !selection.chosen.empty()) calibrate(selection, division);
    if (d_.null_calibration) clock.ended("nulls");
    conclusion_.name(selection);
    another.add_alternatives(conclusion_.causes());
    conclusion_.conclude(selection, division);
    clock.ended("held-out logs and intervals");
    if (options_.gauge && options_.null_campaigns == 0 && d_.verdict == Verdict::unexplained) {
      look_for_base(another, selection);
      if (another.is_found()) conclusion_.adopt(another.found(), selection);
      clock.ended("base");
    }
    return {};
  }

  /// Returns the readings that the refitted model predicts, one value per row of each log.
  [[nodiscard]] std::vector<std::vector<double>> responses() const {
    const FitPoint& point = d_.recalibrated.point;
    const std::vector<Record> records = make_records(logs_, options_.record);
    std::vector<std::vector<double>> all;
    for (std::size_t k = 0; k < records.size(); ++k)
      all.push_back(predict(point.model, records[k], point.starts[k]));
    return all;
  }

  /// Removes those valve causes that the diagnosis has also found in the displacement.
  void take_out_named(ValveFindings& in_valve) {
    std::erase_if(in_valve.named, [&](const NamedCause& one) { return is_among(d_.causes, one.cause); });
  }

  tl::expected<void, std::string> prepare() {
    std::vector<Record> records = make_records(logs_, options_.record);
    const std::size_t readings = reading_count(records);
    if (readings < limits::fewest_readings) {
      return Failure("only " + std::to_string(readings) +
                     " readings in total are too few to separate a cause from noise (" +
                     std::to_string(limits::fewest_readings) + " are needed)");
    }
    // The zero offset of a log is fitted only if the offset of the first log or the initial state of the log
    // is unknown. In all other cases, an offset that changes from log to log must stay in the data. It shows
    // a drift of the sensor.
    const bool zero_free = records.front().offset_free && !records.front().start_unknown;
    for (Record& record : records) record.offset_free = zero_free || record.start_unknown;
    d_.sampling = hide_repeated(records);
    if (!states_resolution(given_, d_.sampling.step_mm)) add_rounding(d_.sampling);
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
    const model::Model given = deterministic_part(given_, options_.record.drive);
    std::vector<StartState> starts = estimated_starts(given, records);
    // The phases of an oscillation in the given model are kept in the records, so that all fits use them.
    for (std::size_t k = 0; k < records.size(); ++k)
      records[k].oscillation_shift_s += std::exchange(starts[k].oscillation_shift_s, 0);
    data_ = make_search_data(std::move(records), given);
    data_.threads = options_.threads;
    data_.scales.has_valve = options_.record.drive == Drive::command;
    d_.records = data_.records;
    d_.as_given = evaluate_structure(data_.records, {}, {data_.given.model, std::move(starts)});
    d_.as_given_rmse_mm = std::sqrt(d_.as_given.mean_square_mm2);
  }

  /// Returns true if the given model contains an oscillation.
  [[nodiscard]] bool oscillates() const {
    return model::position_of<model::PeriodicDisturbance>(given_).has_value();
  }

  /// Hides outliers that occur during a motion. Only the residual of the refitted model shows these outliers.
  /// A new fit without them is more accurate and may reveal further outliers, so the search is repeated up to
  /// three times.
  void hide_more_outliers(StructureFit& base) {
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<Record> records = data_.records;
      if (hide_outliers_beside(records, base.residual_mm, d_.noise_mm, d_.outliers) == 0) return;
      use(std::move(records));
      base = fit_structure(data_.records, {}, base.point);
    }
  }

  /// Handles logs whose pressure is zero at the start although the finger is still moving. The given
  /// structure is fitted with estimated initial states. If this fit explains the logs better than the causes
  /// that were found, it replaces the refitted model, and the function returns true.
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
                   limits::negligible_share * square(d_.noise_mm), options_.seed))
      return false;
    // With estimated initial states, slow creep can imitate the differences between logs of two rigs.
    if (inconsistent_among(data_.records, selection.base, fit.mean_square_mm2)) return false;
    use(std::move(open));
    d_.recalibrated = std::move(fit);
    d_.warnings.emplace_back(
        "The logs begin without pressure, but the finger is still moving. The initial state of each log is "
        "therefore estimated. This estimate may hide a slow change at the beginning of the log");
    return true;
  }

  /// Shifts the drive of the records in time if the readings react before the command changes and the shift
  /// reduces the held-out error significantly. Returns true if the drive was shifted; the search for causes
  /// must then be repeated.
  bool shift_drive(const Selection& selection, const Division& division) {
    std::optional<LeadFit> shifted = fit_lead(data_, selection, d_.noise_mm);
    if (!shifted) return false;
    const BlockLosses losses = held_out_losses(shifted->records, division, shifted->fit);
    if (!is_missed(selection.base_losses, losses, limits::negligible_share * square(d_.noise_mm),
                   options_.seed))
      return false;
    conclusion_.drive_is_shifted({d_.as_given_rmse_mm, selection.base_losses, losses});
    use(std::move(shifted->records));
    d_.recalibrated = std::move(shifted->fit);
    d_.lead = shifted->lead;
    return true;
  }

  /// Searches for stick-slip of the valve, because a simulation from the command alone cannot predict the
  /// jumps of a sticking valve. If stick-slip explains the remaining error, returns true and replaces
  /// `selection` by the causes that were found with the valve position as input.
  bool look_for_stick_slip(Selection& selection, const Division& division) {
    if (options_.record.drive != Drive::command) return false;
    if (options_.progress) options_.progress("search for stick-slip");
    SelectionOptions one_more;
    one_more.most_causes = 1;
    one_more.seed = options_.seed;
    one_more.progress = options_.progress;
    auto found = select_behind_stick_slip(data_, selection, d_.noise_mm, division, one_more);
    if (!found || conclusion_.leaves_too_much(found->selection)) return false;
    // A path of many small steps can fit any residual. Stick-slip is therefore accepted only if it removes at
    // least 75 % of the remaining mean square.
    if (square(found->selection.left.excess_mm) > left_by_what_was_missing * square(selection.left.excess_mm))
      return false;
    selection = std::move(found->selection);
    d_.stick_slip = found->evidence;
    return true;
  }

  /// Returns true if another base structure may be searched at once. If there are gauge readings or simulated
  /// data without a cause, the selection must be tested with them first.
  [[nodiscard]] bool may_ask_at_once() const { return !options_.gauge && options_.null_campaigns == 0; }

  void look_for_base(AnotherBase& another, const Selection& selection) {
    ask_for_base(another, selection);
    another.go_on(selection);
  }

  void ask_for_base(AnotherBase& another, const Selection& selection) {
    if (auto inconsistent = another.ask(selection, d_.recalibrated)) d_.warnings.push_back(*inconsistent);
  }

  Selection search(StructureFit recalibrated, const Division& division, AnotherBase& another) {
    if (oscillates()) {
      data_.scales.residual_lines = spectrum_peaks(data_.records, recalibrated.residual_mm);
    } else {
      AlignedLines aligned = aligned_lines(data_.records, recalibrated.residual_mm);
      for (std::vector<Record>* records : {&data_.records, &data_.thinned, &data_.glimpsed})
        set_oscillation_shifts(*records, aligned.shifts_s);
      data_.scales.residual_lines = std::move(aligned.lines);
    }
    SelectionOptions options;
    options.seed = options_.seed;
    options.progress = options_.progress;
    std::optional<Selection> one_is_not_enough;
    if (conclusion_.left_by_outliers(
            unexplained_error_of(recalibrated.residual_mm, d_.noise_mm, data_.scales.step_mm)))
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

  void calibrate(const Selection& selection, const Division& division) {
    NullOptions nulls;
    nulls.campaigns = options_.null_campaigns;
    nulls.seed = options_.seed;
    if (options_.progress) {
      nulls.progress = [&](std::size_t done) {
        options_.progress("data simulated without a cause: " + std::to_string(done) + " of " +
                          std::to_string(options_.null_campaigns));
      };
    }
    conclusion_.calibrate(selection, division, nulls);
  }

  const std::vector<Log>& logs_;
  const model::Model& given_;
  const DiagnosisOptions& options_;
  SearchData data_;
  Diagnosis d_;
  Conclusion conclusion_;
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
