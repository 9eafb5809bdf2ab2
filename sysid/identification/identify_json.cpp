#include <cmath>

#include <nlohmann/json.hpp>

#include "model/file/model_file.h"
#include "sysid/identification/identify_report.h"
#include "sysid/identification/score_json.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

using Json = nlohmann::ordered_json;

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
  for (const Estimate& e : list) json[e.name] = estimate(e);
  return json;
}

}  // namespace

std::string identify_json(const IdentifyReport& report) {
  const Identification& r = report.result;
  Json json{{"schema", 1}, {"software", software_and_version()}, {"verdict", verdict_of(r)}};
  json["model"] = {{"name", r.model.name}, {"hash", model::model_hash(r.model)}, {"file", "model.yaml"}};
  json["start"] = {{"name", report.start.name}, {"hash", model::model_hash(report.start)}};
  json["logs"] = logs_json(report.logs);
  add_scores(json, r.scores);
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
  if (!r.held_out.empty()) add_scores(json["held_out"], r.held_out);
  if (!report.validation.empty()) {
    if (report.validation_logs != nullptr) json["validation"]["logs"] = logs_json(*report.validation_logs);
    add_scores(json["validation"], report.validation);
  }
  json["warnings"] = r.warnings;
  json["iterations"] = r.iterations;
  json["converged"] = r.converged;
  json["wall_s"] = r.wall_s;
  return json.dump(2) + "\n";
}

}  // namespace softgrip::sysid
