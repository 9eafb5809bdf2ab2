#include "sysid/diagnosis/verdict/conclusion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "base/statistics.h"
#include "base/text.h"
#include "sysid/diagnosis/causes/clock_offset.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/verdict/another_base.h"
#include "sysid/diagnosis/verdict/data_warnings.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

void Conclusion::count_shift(const BlockLosses& extended) {
  if (!d_.lead) return;
  d_.as_given_rmse_mm = unshifted_.as_given_rmse_mm;
  d_.recalibrated_rmse_mm = rmse_mm(unshifted_.recalibrated);
  d_.gain = gain_percent(unshifted_.recalibrated, extended, options_.seed);
}

bool Conclusion::leaves_too_much(const Selection& selection) const {
  if (!selection.left.present) return false;
  if (selection.extended.causes.empty()) {
    return !left_by_outliers(selection.left) && selection.left.excess_mm > worth_a_look * d_.noise_mm;
  }
  return sysid::leaves_too_much(selection.left, selection.base_unexplained, d_.noise_mm);
}

void Conclusion::adopt(BaseFindings& base, const Selection& selection) {
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
  d_.unexplained_error = unexplained_error_of(d_.extended.residual_mm, d_.noise_mm, data_.scales.step_mm);
  d_.unexplained_percent =
      std::min(100.0, 100 * square(d_.unexplained_error.excess_mm / selection.base_unexplained.excess_mm));
  count_shift(base.losses);
  d_.extended_model = named_model(d_.extended.point.model, "extended");
  // A structure that explains only a small part of the error is no evidence for its components.
  const bool explains = d_.unexplained_percent < 100 * (1 - limits::least_explained_share);
  std::vector<NamedCause>& components = explains ? d_.causes : d_.partial;
  components = std::move(base.named);
  std::vector<NamedCause> in_readings = found_in_readings();
  d_.causes.insert(d_.causes.begin(), std::make_move_iterator(in_readings.begin()),
                   std::make_move_iterator(in_readings.end()));
  std::ranges::move(base.possible, std::back_inserter(d_.partial));
  const bool whole = !sysid::leaves_too_much(d_.unexplained_error, selection.base_unexplained, d_.noise_mm);
  d_.verdict = d_.causes.empty()             ? Verdict::unexplained
               : !whole                      ? Verdict::partly_explained
               : any_alternatives(d_.causes) ? Verdict::ambiguous
                                             : Verdict::cause_found;
}

void Conclusion::measure_recalibrated(const Selection& selection) {
  d_.unexplained_recalibrated = selection.base_unexplained;
  d_.recalibrated_rmse_mm = rmse_mm(selection.base_losses);
  d_.rejected = selection.last_candidates;
  d_.recalibrated_model = named_model(selection.base.point.model, "recalibrated");
  warn_unphysical(d_.recalibrated_model, d_.warnings);
}

void Conclusion::measure(const Selection& selection, const Division& division) {
  measure_recalibrated(selection);
  measure_extended(selection, division);
}

void Conclusion::calibrate(const Selection& selection, const Division& division, const NullOptions& nulls) {
  // The drive of the simulated data is already shifted, so their searches cannot gain by a shift. d_.gain may
  // contain the effect of the shift.
  const Spread gain = gain_percent(selection.base_losses, selection.extended_losses, options_.seed);
  d_.null_calibration = calibrate_on_nulls(data_, d_.recalibrated, gain.value, division, nulls);
}

void Conclusion::measure_extended(const Selection& selection, const Division& division) {
  d_.extended = selection.extended;
  d_.unexplained_error = selection.left;
  d_.extended_rmse_mm = rmse_mm(selection.extended_losses);
  d_.gain = gain_percent(selection.base_losses, selection.extended_losses, options_.seed);
  // The refitted model is compared with the given model. The initial states are fitted for both models, so
  // the comparison shows only the effect of the parameters.
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

model::Model Conclusion::named_model(model::Model model, const std::string& how) const {
  // The input of the models for the daemon is the command. The blocks of the valve are therefore added.
  if (options_.record.drive == Drive::measured && d_.in_valve)
    model = with_valve(std::move(model), d_.in_valve->stage);
  model.name = given_.name + '_' + how.substr(0, how.find(' '));
  model.source = how + " by softgrip diagnose from " + with_commas(logs_, &Log::name) +
                 "; source of the given model: " + given_.source;
  return model;
}

std::vector<NamedCause> Conclusion::found_in_readings() const {
  std::vector<NamedCause> named =
      causes_in_readings(d_.outliers, d_.sampling, d_.noise_mm, d_.records.front().output_unit);
  if (d_.lead) {
    NamedCause lead;
    lead.cause = *find_cause(causes::ClockOffset::id);
    lead.block_type = lead.cause.forms.front().type;
    lead.parameters = {{"lead_s", "s", d_.lead->lead_s, d_.lead->ci95, true}};
    lead.gain_percent = gain_percent(unshifted_.recalibrated, unshifted_.shifted, options_.seed);
    lead.gain_mm2 = mean_difference(unshifted_.recalibrated, unshifted_.shifted, options_.seed);
    named.push_back(std::move(lead));
  }
  return named;
}

void Conclusion::name(const Selection& selection) {
  causes_ = found_in_readings();
  std::vector<NamedCause> chosen = name_chosen(data_.records, selection.extended, selection.chosen);
  if (!d_.stick_slip) {
    for (std::string& sentence : mix_intervals(chosen, data_.records, selection, options_.seed))
      d_.warnings.push_back(std::move(sentence));
  }
  for (NamedCause& named : chosen) {
    if (d_.stick_slip && named.cause.id == causes::ValveDeadband::id) {
      // The reported band is the band of the stick-slip motion. The band in the extended model may be
      // different, because it may have been fitted to the mean of all possible stick-slip motions.
      named.parameters.front() = {"band_kpa", "kPa", d_.stick_slip->band_kpa, d_.stick_slip->band_ci95, true};
    }
    causes_.push_back(std::move(named));
  }
}

bool Conclusion::left_by_outliers(const UnexplainedError& structure) const {
  return d_.outliers.present && structure.slow_correlation <= limits::form_error_share &&
         structure.excess_mm < d_.noise_mm;
}

void Conclusion::count_readings(const UnexplainedError& left) {
  if (!d_.outliers.present && !d_.sampling.present) return;
  const double left_mm2 = square(left.excess_mm);
  const double explained_mm2 = (d_.outliers.present ? square(d_.outliers.excess_mm) : 0) +
                               (d_.sampling.present ? square(d_.sampling.excess_mm) : 0);
  d_.unexplained_percent = left.present ? 100 * left_mm2 / (left_mm2 + explained_mm2) : 0;
}

bool Conclusion::name_readings_alone(const Selection& selection, const Division& division) {
  const auto is_chosen = [&](const NamedCause& named) {
    return std::ranges::find(selection.chosen, named.cause, &ChosenCause::cause) != selection.chosen.end();
  };
  const auto first = std::stable_partition(causes_.begin(), causes_.end(), std::not_fn(is_chosen));
  if (first == causes_.begin()) return false;
  d_.causes.assign(std::make_move_iterator(causes_.begin()), std::make_move_iterator(first));
  d_.partial.assign(std::make_move_iterator(first), std::make_move_iterator(causes_.end()));
  const Selection alone =
      selection_from(selection.base, selection.base_losses, d_.noise_mm, data_.scales.step_mm);
  d_.extended_other_logs_rmse_mm.reset();
  measure_extended(alone, division);
  count_readings(alone.left);
  d_.verdict = Verdict::partly_explained;
  return true;
}

void Conclusion::conclude(const Selection& selection, const Division& division) {
  // If the gauge readings have replaced a named cause, the remaining error does not affect the verdict.
  const bool placed_by_gauge = d_.gauge && d_.gauge->replaced;
  const bool too_much_left = !placed_by_gauge && leaves_too_much(selection);
  const bool by_chance = d_.null_calibration && d_.null_calibration->reach_the_gain();
  if (by_chance && !too_much_left && name_readings_alone(selection, division)) return;
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
  if (selection.chosen.empty()) count_readings(selection.left);
  if (!d_.causes.empty()) {
    d_.verdict = any_alternatives(d_.causes) ? Verdict::ambiguous : Verdict::cause_found;
    return;
  }
  const bool better = recalibration_gain_.lower > 0 &&
                      recalibration_gain_.value > limits::negligible_share * square(d_.noise_mm);
  d_.verdict = better ? Verdict::recalibrate : Verdict::adequate;
}

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

}  // namespace softgrip::sysid
