#include "sysid/changes/change_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sysid/changes/next_steps.h"

namespace softgrip::sysid {
namespace {

using Json = nlohmann::ordered_json;

Json interval_json(const std::optional<Interval>& interval) {
  return interval ? Json{interval->lower, interval->upper} : Json(nullptr);
}

Json cause_json(const ChangeCause& cause) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < cause.fitted.numbers.size(); ++i)
    parameters[cause.fitted.effect.numbers[i].name] = {{"value", cause.fitted.numbers[i]},
                                                       {"ci95", interval_json(cause.intervals.numbers[i])}};
  const auto steps = next_steps(cause.id);
  return {{"id", cause.id},
          {"form", cause.fitted.effect.form},
          {"station", model::name_of(cause.station)},
          {"parameters", std::move(parameters)},
          {"size",
           {{"what", cause.size.what},
            {"value", cause.size.value},
            {"unit", model::in_unit(cause.size.unit, cause.output_unit)},
            {"ci95", interval_json(cause.intervals.size)}}},
          {"full_pressure", cause.full_pressure_mm},
          {"effect_rms", cause.effect_mm},
          {"unit", unit_of(cause.judged, cause.output_unit)},
          {"share_percent", cause.share_percent},
          {"gain", {{"value", cause.gain}, {"ci95", {cause.gain_lower, cause.gain_upper}}}},
          {"next_steps", {steps[0], steps[1]}}};
}

Json reading_json(const JudgedChange& judged) {
  Json tried = Json::array();
  for (const TriedCause& alternative : judged.tried)
    tried.push_back(
        {{"id", alternative.id},
         {"form", alternative.form},
         {"gain", alternative.gain},
         {"healthy_gain", alternative.healthy_gain},
         {"tolerance", alternative.tolerance},
         {"rejected", alternative.rejected.empty() ? Json(nullptr) : Json(alternative.rejected)}});
  Json runs = Json::array();
  for (const RunLeft& run : judged.runs)
    runs.push_back({{"run", run.run},
                    {"healthy", run.is_healthy},
                    {"base_rms", run.base},
                    {"explained_rms", run.explained}});
  return {{"reading", judged.judged == Judged::pressure ? "pressure_kpa" : "displacement_mm"},
          {"unit", unit_of(judged.judged, judged.output_unit)},
          {"base", judged.base},
          {"noise", judged.noise_mm},
          {"healthy_runs", judged.healthy_runs},
          {"healthy_heldout_rms", judged.healthy_mm},
          {"allowed_rms", judged.allowed_mm},
          {"later_rms", judged.later_mm},
          {"explained_rms", judged.explained_mm},
          {"whitened_loss", {{"before", judged.loss_before}, {"left", judged.loss_left}}},
          {"misfit", {{"before", judged.loss_before}, {"left", judged.loss_left}}},
          {"unexplained", judged.left_over},
          {"structure_left", judged.left_over},
          {"zero", judged.zero_mm},
          {"gain_percent", judged.gain_percent},
          {"not_tested", judged.not_tested},
          {"runs", std::move(runs)},
          {"tried", std::move(tried)}};
}

}  // namespace

Json json_of(const ChangeDiagnosis& d) {
  Json json;
  json["schema"] = 1;
  json["question"] = "change";
  json["verdict"] = name_of(d.verdict);
  json["output_unit"] = model::name_of(d.output_unit);
  json["causes"] = Json::array();
  json["alternatives"] = Json::array();
  for (const ChangeCause& cause : d.causes) {
    json["causes"].push_back(cause_json(cause));
    json["alternatives"].push_back(cause.alternatives);
  }
  const JudgedChange& finger = d.readings.back();
  json["noise_mm"] = finger.noise_mm;
  json["heldout_rmse_mm"] = {
      {"as_given", finger.later_mm}, {"recalibrated", finger.later_mm}, {"extended", finger.explained_mm}};
  const double gain = finger.later_mm > 0 ? 100 * (1 - finger.explained_mm / finger.later_mm) : 0;
  json["gain_percent"] = {{"value", gain}, {"ci95", nullptr}};
  const double excess = finger.loss_before - 1;
  json["unexplained_percent"] =
      excess > 0 ? std::clamp(100 * (finger.loss_left - 1) / excess, 0.0, 100.0) : 0.0;
  json["partial_causes"] = Json::array();
  json["base"] = finger.base;
  json["next_experiment"] = nullptr;
  json["readings"] = Json::array();
  for (const JudgedChange& judged : d.readings) json["readings"].push_back(reading_json(judged));
  json["warnings"] = d.warnings;
  json["wall_s"] = d.wall_s;
  return json;
}

}  // namespace softgrip::sysid
