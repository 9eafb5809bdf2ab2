#include <functional>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/report/report_sections.h"

namespace softgrip::sysid {
namespace {

using result::Fields, result::keyed, result::list_of, result::or_null, result::shown, result::Value;

Fields fields_of_cause(const Diagnosis& d, const NamedCause& named, const Budget& budget) {
  Fields parameters;
  for (const CauseParameter& p : named.parameters) {
    parameters.emplace_back(p.name, parameter_fields("", p));
    parameters.emplace_back(p.formerly, parameter_fields("", p));  // an empty key is not written
  }
  Fields fields{{"id", named.cause.id},
                {"form", model::catalogue()[named.block_type].info.id},
                {"station", model::name_of(named.cause.station)},
                {"parameters", std::move(parameters)},
                {"heldout_error_reduction_percent", spread_value(named.gain_percent)},
                {"heldout_gain_percent", spread_value(named.gain_percent)},  // this key is deprecated
                {"inclusion", named.inclusion},
                {"share_percent", budget.share_percent(named)}};
  if (named.gain_kpa2) {
    fields.emplace_back("judged_by", "pressure_kpa");
    fields.emplace_back("gain_kpa2", spread_value(*named.gain_kpa2));
  }
  if (named.only_in_loop) {
    fields.emplace_back("judged_by", "one_step_prediction");
    fields.emplace_back("in_extended_model", position_of(d.extended_model, named.cause).has_value());
  }
  return fields;
}

/// Returns the fields of the model of the path from the command to the measured pressure.
Fields fields_of_valve(const ValveFindings& in_valve) {
  const ValveStage& stage = in_valve.stage;
  return {{"delay_s", stage.delay_s},
          {"filling_time_constant_s", stage.filling_s},
          {"venting_time_constant_s", stage.venting_s},
          {"heldout_rmse_kpa", in_valve.heldout_rmse_kpa},
          {"noise_kpa", in_valve.noise_kpa}};
}

/// Returns the fields of the error budget. The values are mean square errors on held-out readings.
Fields fields_of_budget(const Diagnosis& d, const Budget& budget) {
  Fields causes;
  for (const NamedCause& named : d.causes)
    causes.emplace_back(std::string(named.cause.id), spread_value(named.gain_mm2));
  return {{"unit", model::in_unit("mm^2", d.extended_model.output_unit)},
          {"as_given", budget.as_given},
          {"recalibrated", budget.recalibrated},
          {"causes", std::move(causes)},
          {"extended", budget.extended},
          {"left", budget.left()},
          {"noise", budget.noise}};
}

/// Returns the candidates as an object. The key is the id of the cause that the candidates were tested to
/// replace, or "none" for the candidates that were tested as an additional cause.
Fields fields_of_candidates(const Diagnosis& d) {
  const auto rows = [&](const NamedCause* chosen) {
    return list_of(candidate_rows(d, chosen), std::identity());
  };
  Fields fields;
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) fields.emplace_back(std::string(named.cause.id), rows(&named));
  }
  if (!d.rejected.empty()) fields.emplace_back("none", rows(nullptr));
  return fields;
}

Value bins_value(const ConditionEvidence& e) {
  const auto& groups = e.condition.groups;
  return list_of(e.bins, [&](const ConditionBin& bin) -> Fields {
    return {{groups.empty() ? "" : "group", groups.empty() ? "" : groups[bin.group]},
            {"value", bin.label.empty() ? Value(bin.value) : Value(bin.label)},
            {"samples", bin.samples},
            {"mean_mm", bin.mean_mm},
            {"ci95", Value::List{bin.lower_mm, bin.upper_mm}},
            {"rms_mm", bin.rms_mm}};
  });
}

Fields fields_of_condition(const ConditionEvidence& e, bool with_bins) {
  if (!e.condition.why_not.empty()) return {{"id", e.condition.id}, {"not_judged", e.condition.why_not}};
  Fields fields{{"id", e.condition.id},
                {"share_percent", e.share_percent},
                {"p_value", e.p_value},
                {"p_adjusted", e.p_adjusted},
                {"clear", e.clear}};
  if (with_bins) fields.emplace_back("bins", bins_value(e));
  return fields;
}

Fields fields_of_residual(const ResidualEvidence& r, bool with_bins) {
  const SpectrumEvidence& spectrum = r.spectrum;
  const Fields line{{"frequency_hz", spectrum.peak_hz},
                    {"amplitude_mm", spectrum.peak_amplitude_mm},
                    {"share_percent", spectrum.share_percent},
                    {"p_value", spectrum.p_value}};
  const auto of_condition = [&](const ConditionEvidence& e) { return fields_of_condition(e, with_bins); };
  return {{"rms_mm", r.rms_mm},
          {"unexplained_rms_mm", r.structure_mm},
          {"structure_mm", r.structure_mm},
          {"correlation_time_s", r.memory_s},
          {"memory_s", r.memory_s},
          {"block_s", r.block_s},
          {"blocks", r.blocks},
          {"conditions", list_of(r.conditions, of_condition)},
          {"line", spectrum.why_not.empty() ? Value(line) : Value()}};
}

Fields fields_of_evidence(const Evidence& evidence) {
  const auto of_sign = [](const UnphysicalSign& sign) -> Fields {
    return {{"name", sign.name},
            {"id", sign.formerly.empty() ? sign.name : sign.formerly},  // this key is deprecated
            {"value", sign.value},
            {"limit", sign.limit},
            {"sentence", sign.sentence}};
  };
  return {{"as_given", fields_of_residual(evidence.as_given, false)},
          {"recalibrated", fields_of_residual(evidence.recalibrated, true)},
          {"extended", fields_of_residual(evidence.extended, false)},
          {"unphysical_recalibration", list_of(evidence.unphysical, of_sign)}};
}

Fields fields_of_gauge(const GaugeEvidence& gauge) {
  const GaugeCheck& check = gauge.check;
  // The deviation of the sensor from a straight line is determined from the gauge readings alone; the logs
  // are not used.
  const GaugeCheck::Departure departure = check.departure();
  const auto of_reading = [](const GaugeReading& r) -> Fields {
    return {{"gauge_mm", r.position_mm}, {"displacement_mm", r.reading_mm}, {"samples", r.samples}};
  };
  const auto of_fit = [&](const GaugeFit& fit) { return hypothesis_fields(fit, gauge.file.output_unit); };
  return {{"file", gauge.file.path},
          {"sha256", gauge.file.sha256},
          {"outcome", name_of(check.outcome)},
          {"sentence", gauge.sentence},
          {"ruled_out", gauge.ruled_out},
          {"covered_percent", 100 * check.covered_share},
          {"noise_mm", check.noise_mm},
          {"repeat_noise_mm", check.repeat_noise_mm},
          {"log_likelihood_ratio", check.log_likelihood_ratio},
          {"hypotheses", list_of(check.fits, of_fit)},
          {"sensor_alone", Fields{{"straight_rms_mm", check.straight.rms_mm},
                                  {"bent_rms_mm", check.free_bend.rms_mm},
                                  {"ending_rms_mm", check.free_end.rms_mm},
                                  {"departure_rms_mm", departure.rms_mm},
                                  {"clear", departure.clear}}},
          {"positions_mm", list_of(distinct_positions(gauge.file.readings), std::identity())},
          {"readings", list_of(gauge.file.readings, of_reading)}};
}

Fields fields_of_nulls(const NullCalibration& nulls) {
  return {{"campaigns", nulls.campaigns},
          {"named", nulls.named},
          {"largest_gain_percent", nulls.largest_gain_percent},
          {"p_value", nulls.p_value}};
}

Fields fields_of_stick_slip(const StickSlipEvidence& stick_slip) {
  return {{"jumps", stick_slip.jumps},
          {"scatter_percent", 100 * stick_slip.scatter},
          {"heldout_rmse_mm", stick_slip.heldout_rmse_mm},
          {"error_reduction_percent", spread_value(stick_slip.gain_percent)},
          {"gain_percent", spread_value(stick_slip.gain_percent)}};  // this key is deprecated
}

}  // namespace

Fields fields_of(const Diagnosis& d) {
  const Budget budget = budget_of(d);
  const auto of_cause = [&](const NamedCause& named) { return fields_of_cause(d, named, budget); };
  const auto alternatives = [](const NamedCause& named) { return list_of(named.alternatives, &Cause::id); };
  std::vector<NamedCause> causes = d.causes;
  if (d.in_valve) causes.insert(causes.end(), d.in_valve->named.begin(), d.in_valve->named.end());
  const model::OutputUnit unit = d.extended_model.output_unit;
  const auto in_unit = [&](double value, int digits) {
    return shown(value, significant(value, digits) + " " + std::string(model::name_of(unit)));
  };
  const auto& other_logs = d.recalibrated_other_logs_rmse_mm;
  const auto& extended_other_logs = d.extended_other_logs_rmse_mm;
  const Value stick_slip = or_null(d.stick_slip, fields_of_stick_slip);
  const Fields unexplained{{"recalibrated", d.unexplained_recalibrated.excess_mm},
                           {"left", d.unexplained_error.excess_mm}};
  return {{"schema", 1},
          {"verdict", name_of(whole_verdict(d))},
          {"output_unit", model::name_of(unit)},
          {"causes", list_of(causes, of_cause)},
          {"alternatives", list_of(causes, alternatives)},
          {"valve", or_null(d.in_valve, fields_of_valve)},
          {"noise_mm", "measurement noise (1 sigma)", in_unit(d.noise_mm, 3)},
          {"heldout_rmse_mm",
           Fields{{"as_given", "RMSE, given model", in_unit(d.as_given_rmse_mm, 4)},
                  {"recalibrated", "held-out RMSE, refitted model", in_unit(d.recalibrated_rmse_mm, 4)},
                  {"extended", "held-out RMSE, extended model", in_unit(d.extended_rmse_mm, 4)}}},
          {other_logs ? "heldout_logs_rmse_mm" : "",
           Fields{{"recalibrated", other_logs},
                  {"extended", extended_other_logs ? extended_other_logs : other_logs}}},
          {"runs", list_of(d.runs, [&](const RunError& run) { return run_fields(d, run); })},
          {"error_reduction_percent", spread_value(d.gain)},
          {"gain_percent", spread_value(d.gain)},  // this key is deprecated
          {"unexplained_percent", "unexplained share",
           shown(d.unexplained_percent, fixed(d.unexplained_percent, 1) + " %")},
          {"budget", fields_of_budget(d, budget)},
          {"structure", or_null(d.base)},
          {"base", or_null(d.base)},  // this key is deprecated
          {"next_experiment", Value()},
          {"null_calibration", or_null(d.null_calibration, fields_of_nulls)},
          {"stick_slip", stick_slip},
          {"staircase", stick_slip},  // this key is deprecated
          {"gauge", or_null(d.gauge, fields_of_gauge)},
          {"not_tested", keyed(d.not_tested)},
          {"partial_causes", list_of(d.partial, of_cause)},
          {"unexplained_rms_mm", unexplained},
          {"structure_mm", unexplained},  // this key is deprecated
          {"candidates", fields_of_candidates(d)},
          {d.evidence ? "evidence" : "", or_null(d.evidence, fields_of_evidence)},
          {"warnings", d.warnings},
          {"wall_s", d.wall_s},
          {"stages_s", keyed(d.stages_s)}};
}

}  // namespace softgrip::sysid
