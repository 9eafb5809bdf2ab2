#include "sysid/diagnosis/report/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "model/catalogue.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {
namespace {

using Json = nlohmann::ordered_json;

Json spread(const Spread& s) {
  return {{"value", s.value}, {"ci95", {s.lower, s.upper}}};
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json cause_json(const NamedCause& named, const Budget& budget) {
  Json parameters = Json::object();
  for (const CauseParameter& p : named.parameters) {
    Json one{{"value", p.value}};
    one["ci95"] = p.has_interval ? Json{p.ci95.lower, p.ci95.upper} : Json(nullptr);
    parameters[p.name] = std::move(one);
  }
  Json json{{"id", named.cause.id},
            {"form", model::catalogue()[named.block_type].info.id},
            {"station", model::name_of(named.cause.station)},
            {"parameters", std::move(parameters)},
            {"heldout_gain_percent", spread(named.heldout_gain_percent)},
            {"inclusion", named.inclusion},
            {"share_percent", budget.share_percent(named)}};
  if (named.gain_kpa2) {
    json["judged_by"] = "pressure_kpa";
    json["gain_kpa2"] = spread(*named.gain_kpa2);
  }
  return json;
}

/// Returns the model of the path from the command to the measured pressure as JSON.
Json valve_json(const ValveFindings& in_valve) {
  const ValveStage& stage = in_valve.stage;
  return {{"delay_s", stage.delay_s},
          {"filling_time_constant_s", stage.filling_s},
          {"venting_time_constant_s", stage.venting_s},
          {"heldout_rmse_kpa", in_valve.heldout_rmse_kpa},
          {"noise_kpa", in_valve.noise_kpa}};
}

/// Returns the error budget as JSON. The values are mean square errors on held-out readings.
Json budget_json(const Diagnosis& d, const Budget& budget) {
  Json causes = Json::object();
  for (const NamedCause& named : d.causes) causes[std::string(named.cause.id)] = spread(named.gain_mm2);
  return {{"unit", model::in_unit("mm^2", d.extended_model.output_unit)},
          {"as_given", number(budget.as_given)},
          {"recalibrated", number(budget.recalibrated)},
          {"causes", std::move(causes)},
          {"extended", number(budget.extended)},
          {"left", budget.left()},
          {"noise", budget.noise}};
}

Json ids_of(const std::vector<Cause>& causes) {
  Json ids = Json::array();
  for (const Cause& cause : causes) ids.push_back(cause.id);
  return ids;
}

Json candidates_json(const std::vector<CandidateScore>& candidates) {
  Json list = Json::array();
  for (const CandidateScore& c : candidates) {
    Json one{{"id", c.cause.id}};
    const bool is_fitted = c.rmse_mm > 0;
    if (!c.why_not.empty()) one[is_fitted ? "rejected" : "not_fitted"] = c.why_not;
    if (is_fitted || c.why_not.empty()) {
      one["rmse_mm"] = number(c.rmse_mm);
      one["heldout_rmse_mm"] = number(c.heldout_rmse_mm);
    }
    list.push_back(std::move(one));
  }
  return list;
}

Json bins_json(const ConditionEvidence& e) {
  Json list = Json::array();
  for (const ConditionBin& bin : e.bins) {
    Json one;
    if (!e.condition.groups.empty()) one["group"] = e.condition.groups[bin.group];
    one["value"] = bin.label.empty() ? Json(bin.value) : Json(bin.label);
    one["samples"] = bin.samples;
    one["mean_mm"] = bin.mean_mm;
    one["ci95"] = {number(bin.lower_mm), number(bin.upper_mm)};
    one["rms_mm"] = bin.rms_mm;
    list.push_back(std::move(one));
  }
  return list;
}

Json residual_json(const ResidualEvidence& r, bool with_bins) {
  Json json{{"rms_mm", r.rms_mm},
            {"unexplained_rms_mm", r.structure_mm},
            {"structure_mm", r.structure_mm},
            {"correlation_time_s", r.memory_s},
            {"memory_s", r.memory_s},
            {"block_s", r.block_s},
            {"blocks", r.blocks}};
  Json conditions = Json::array();
  for (const ConditionEvidence& e : r.conditions) {
    Json one{{"id", e.condition.id}};
    if (e.condition.why_not.empty()) {
      one["share_percent"] = e.share_percent;
      one["p_value"] = e.p_value;
      one["p_adjusted"] = e.p_adjusted;
      one["clear"] = e.clear;
      if (with_bins) one["bins"] = bins_json(e);
    } else {
      one["not_judged"] = e.condition.why_not;
    }
    conditions.push_back(std::move(one));
  }
  json["conditions"] = std::move(conditions);
  if (r.spectrum.why_not.empty()) {
    json["line"] = {{"frequency_hz", r.spectrum.peak_hz},
                    {"amplitude_mm", r.spectrum.peak_amplitude_mm},
                    {"share_percent", r.spectrum.share_percent},
                    {"p_value", r.spectrum.p_value}};
  } else {
    json["line"] = nullptr;
  }
  return json;
}

Json evidence_json(const Evidence& evidence) {
  Json unphysical = Json::array();
  for (const UnphysicalSign& sign : evidence.unphysical) {
    unphysical.push_back(
        {{"id", sign.id}, {"value", sign.value}, {"limit", sign.limit}, {"sentence", sign.sentence}});
  }
  return {{"as_given", residual_json(evidence.as_given, false)},
          {"recalibrated", residual_json(evidence.recalibrated, true)},
          {"extended", residual_json(evidence.extended, false)},
          {"unphysical_recalibration", std::move(unphysical)}};
}

Json gauge_json(const GaugeEvidence& gauge) {
  const GaugeCheck& check = gauge.check;
  Json json{{"file", gauge.file.path},
            {"sha256", gauge.file.sha256},
            {"outcome", name_of(check.outcome)},
            {"sentence", gauge.sentence},
            {"ruled_out", gauge.ruled_out},
            {"covered_percent", 100 * check.covered_share},
            {"noise_mm", check.noise_mm},
            {"repeat_noise_mm", check.repeat_noise_mm},
            {"log_likelihood_ratio", check.log_likelihood_ratio}};
  json["hypotheses"] = Json::array();
  for (const GaugeFit& fit : check.fits) {
    json["hypotheses"].push_back({{"id", fit.shape.id()},
                                  {"rms_mm", fit.rms_mm},
                                  {"tolerance_mm", fit.tolerance_mm},
                                  {"explains", fit.explains},
                                  {"behind", fit.behind},
                                  {"ruled_out", fit.ruled_out},
                                  {"zero_mm", fit.zero_mm},
                                  {"scale", fit.scale}});
  }
  // The deviation of the sensor from a straight line is determined from the gauge readings alone; the logs
  // are not used.
  const GaugeCheck::Departure departure = check.departure();
  json["sensor_alone"] = {{"straight_rms_mm", check.straight.rms_mm},
                          {"bent_rms_mm", check.free_bend.rms_mm},
                          {"ending_rms_mm", check.free_end.rms_mm},
                          {"departure_rms_mm", departure.rms_mm},
                          {"clear", departure.clear}};
  json["positions_mm"] = distinct_positions(gauge.file.readings);
  json["readings"] = Json::array();
  for (const GaugeReading& r : gauge.file.readings) {
    json["readings"].push_back(
        {{"gauge_mm", r.position_mm}, {"displacement_mm", r.reading_mm}, {"samples", r.samples}});
  }
  return json;
}

}  // namespace

Json json_of(const Diagnosis& d) {
  Json json;
  json["schema"] = 1;
  json["verdict"] = name_of(whole_verdict(d));
  json["output_unit"] = model::name_of(d.extended_model.output_unit);
  const Budget budget = budget_of(d);
  json["causes"] = Json::array();
  json["alternatives"] = Json::array();
  for (const NamedCause& named : d.causes) {
    json["causes"].push_back(cause_json(named, budget));
    json["alternatives"].push_back(ids_of(named.alternatives));
  }
  json["valve"] = d.in_valve ? valve_json(*d.in_valve) : Json(nullptr);
  if (d.in_valve) {
    for (const NamedCause& named : d.in_valve->named) {
      json["causes"].push_back(cause_json(named, budget));
      json["alternatives"].push_back(ids_of(named.alternatives));
    }
  }
  json["noise_mm"] = d.noise_mm;
  json["heldout_rmse_mm"] = {{"as_given", number(d.as_given_rmse_mm)},
                             {"recalibrated", number(d.recalibrated_rmse_mm)},
                             {"extended", number(d.extended_rmse_mm)}};
  if (d.recalibrated_other_logs_rmse_mm) {
    json["heldout_logs_rmse_mm"] = {
        {"recalibrated", number(*d.recalibrated_other_logs_rmse_mm)},
        {"extended", number(d.extended_other_logs_rmse_mm.value_or(*d.recalibrated_other_logs_rmse_mm))}};
  }
  json["runs"] = Json::array();
  for (const RunError& one : d.runs) {
    json["runs"].push_back({{"run", one.run},
                            {"as_given_rmse_mm", number(one.given)},
                            {"recalibrated_rmse_mm", number(one.recalibrated)},
                            {"extended_rmse_mm", number(one.extended)}});
  }
  json["gain_percent"] = spread(d.gain);
  json["unexplained_percent"] = d.unexplained_percent;
  json["budget"] = budget_json(d, budget);
  json["base"] = d.base.empty() ? Json(nullptr) : Json(d.base);
  json["next_experiment"] = nullptr;
  json["null_calibration"] = nullptr;
  if (const auto& nulls = d.null_calibration) {
    json["null_calibration"] = {{"campaigns", nulls->campaigns},
                                {"named", nulls->named},
                                {"largest_gain_percent", nulls->largest_gain_percent},
                                {"p_value", nulls->p_value}};
  }
  json["stick_slip"] = nullptr;
  if (const auto& stick_slip = d.stick_slip) {
    json["stick_slip"] = {{"jumps", stick_slip->jumps},
                          {"scatter_percent", 100 * stick_slip->scatter},
                          {"heldout_rmse_mm", stick_slip->heldout_rmse_mm},
                          {"gain_percent", spread(stick_slip->gain_percent)}};
  }
  json["staircase"] = json["stick_slip"];  // the key `staircase` is deprecated
  json["gauge"] = d.gauge ? gauge_json(*d.gauge) : Json(nullptr);
  json["not_tested"] = d.not_tested;
  json["partial_causes"] = Json::array();
  for (const NamedCause& named : d.partial) json["partial_causes"].push_back(cause_json(named, budget));
  json["unexplained_rms_mm"] = {{"recalibrated", d.unexplained_recalibrated.excess_mm},
                                {"left", d.unexplained_error.excess_mm}};
  json["structure_mm"] = json["unexplained_rms_mm"];  // the key `structure_mm` is deprecated
  Json candidates = Json::object();
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) {
      candidates[std::string(named.cause.id)] = candidates_json(named.candidates);
    }
  }
  if (!d.rejected.empty()) candidates["none"] = candidates_json(d.rejected);
  json["candidates"] = std::move(candidates);
  if (d.evidence) json["evidence"] = evidence_json(*d.evidence);
  json["warnings"] = d.warnings;
  json["wall_s"] = d.wall_s;
  Json stages = Json::object();
  for (const auto& [stage, took_s] : d.stages_s) stages[stage] = took_s;
  json["stages_s"] = std::move(stages);
  return json;
}

}  // namespace softgrip::sysid
