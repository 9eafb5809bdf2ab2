#include <nlohmann/json.hpp>

#include "base/json.h"
#include "model/file/model_file.h"
#include "sysid/identification/identify_report.h"
#include "sysid/identification/log_report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

using Json = nlohmann::ordered_json;
using result::json_of;

Json interval(const std::optional<Interval>& given) {
  return given ? Json::array({given->lower, given->upper}) : Json(nullptr);
}

Json estimate(const Estimate& e) {
  Json json{
      {"value", e.value}, {"ci95", interval(e.ci95)}, {"identifiable", e.identifiable}, {"free", e.free}};
  if (!e.unit.empty()) json["unit"] = e.unit;
  if (!e.formula.empty()) json["formula"] = e.formula;
  if (e.profile95) json["profile95"] = interval(e.profile95);
  if (!e.note.empty()) json["note"] = e.note;
  return json;
}

Json estimates(const std::vector<Estimate>& list) {
  Json json = Json::object();
  for (const Estimate& e : list) {
    json[e.name] = estimate(e);
    if (!e.formerly.empty()) json[e.formerly] = estimate(e);
  }
  return json;
}

Json structure(const StructureEvidence& s) {
  Json json{{"held_out", "interleaved_blocks"}, {"blocks", s.blocks}, {"ridge", s.ridge}};
  for (const StructureEvidence::Candidate& c : s.candidates) {
    if (c.chosen) {
      json["id"] = c.structure;
      json["description"] = c.description;
    }
    json["candidates"].push_back({{"id", c.structure},
                                  {"description", c.description},
                                  {"rmse_mm", c.rmse_mm},
                                  {"heldout_rmse_mm", c.heldout_rmse_mm},
                                  {"chosen", c.chosen}});
  }
  json["ablation"] = Json::array();
  for (const StructureEvidence::Ablation& a : s.ablation)
    json["ablation"].push_back(
        {{"without", a.without}, {"rmse_mm", a.rmse_mm}, {"heldout_rmse_mm", a.heldout_rmse_mm}});
  if (!s.valve) return json;
  json["valve"] = {{"delay_s", s.valve->delay_s},
                   {"filling_time_constant_s", s.valve->filling_time_constant_s},
                   {"venting_time_constant_s", s.valve->venting_time_constant_s},
                   {"rmse_kpa", s.valve->rmse_kpa},
                   {"rmse_percent_of_range", s.valve->rmse_percent_of_range},
                   {"sample_to_sample_noise_kpa", s.valve->noise_kpa}};
  if (s.valve->held_out_rmse_kpa > 0) json["valve"]["held_out_rmse_kpa"] = s.valve->held_out_rmse_kpa;
  json["valve"]["from_command"] = nullptr;
  if (!s.valve->from_command.empty())
    json["valve"]["from_command"] = json_of(fields_of(s.valve->from_command));
  return json;
}

}  // namespace

std::string identify_json(const IdentifyReport& report) {
  const Identification& r = report.result;
  Json json{{"schema", 1}, {"software", software_and_version()}, {"verdict", verdict_of(r)}};
  json["call"] = report.call;
  json["model"] = {{"name", r.model.name}, {"hash", model::model_hash(r.model)}, {"file", "model.yaml"}};
  json["start"] = {{"name", report.start.name}, {"hash", model::model_hash(report.start)}};
  json["output_unit"] = model::name_of(r.model.output_unit);
  json["logs"] = json_of(logs_value(report.logs));
  json.update(json_of(fields_of(r.scores)));
  json["parameters"] = estimates(r.parameters);
  json["combinations"] = estimates(r.combinations);
  if (!r.starts.empty()) json["starts"] = estimates(r.starts);
  json["loose_directions"] = Json::array();
  for (const LooseDirection& loose : r.loose) {
    Json direction = Json::object();
    for (std::size_t i = 0; i < loose.names.size(); ++i) direction[loose.names[i]] = loose.weights[i];
    json["loose_directions"].push_back({{"deviation", loose.deviation}, {"direction", direction}});
  }
  json["multistart"] = {{"starts", r.multistart.starts},
                        {"share_reached_best", r.multistart.share_at_best},
                        {"seed", report.seed},
                        {"rmse_mm", r.multistart.rmse_mm}};
  json["residuals"] = {{"rmse_mm", r.rmse_mm},
                       {"noise_mm", r.noise.deviation_mm},
                       {"lag1_correlation", r.noise.lag1_correlation},
                       {"autoregressive_order", r.noise.coefficients.size()},
                       {"effective_samples", r.noise.effective_samples},
                       {"sample_to_sample_noise_mm", r.fast_noise_mm}};
  if (r.huber_mm > 0) json["residuals"]["huber_mm"] = r.huber_mm;
  for (const auto& [exponent, rmse_mm] : r.exponent_rmse_mm) {
    json["exponents"].push_back({{"exponent", exponent}, {"rmse_mm", rmse_mm}});
  }
  if (!r.held_out.empty()) {
    json["held_out"]["kind"] = "continuation";
    json["held_out"].update(json_of(fields_of(r.held_out)));
  }
  if (r.structure) json["structure"] = structure(*r.structure);
  if (!report.validation.empty()) {
    if (report.validation_logs != nullptr)
      json["validation"]["logs"] = json_of(logs_value(*report.validation_logs));
    json["validation"].update(json_of(fields_of(report.validation)));
  }
  json["warnings"] = r.warnings;
  json["iterations"] = r.iterations;
  json["converged"] = r.converged;
  json["wall_s"] = r.wall_s;
  return json_dump(json, 2) + "\n";
}

}  // namespace softgrip::sysid
