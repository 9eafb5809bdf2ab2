#include <cmath>
#include <nlohmann/json.hpp>

#include "model/catalogue.h"
#include "sysid/diagnosis/diagnosis.h"

namespace softgrip::sysid {
namespace {

using Json = nlohmann::ordered_json;

Json spread(const Spread& s) {
  return {{"value", s.value}, {"ci95", {s.lower, s.upper}}};
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json cause_json(const NamedCause& named) {
  Json parameters = Json::object();
  for (const CauseParameter& p : named.parameters) {
    Json one{{"value", p.value}};
    one["ci95"] = p.has_interval ? Json{p.ci95.lower, p.ci95.upper} : Json(nullptr);
    parameters[p.name] = std::move(one);
  }
  return {{"id", named.cause.id},
          {"station", model::name_of(named.cause.station)},
          {"parameters", std::move(parameters)},
          {"heldout_gain_percent", spread(named.heldout_gain_percent)}};
}

Json candidates_json(const std::vector<CandidateScore>& candidates) {
  Json list = Json::array();
  for (const CandidateScore& c : candidates) {
    Json one{{"id", c.cause.id}};
    if (!c.why_not.empty()) {
      one["not_fitted"] = c.why_not;
    } else {
      one["rmse_mm"] = number(c.rmse_mm);
      one["heldout_rmse_mm"] = number(c.heldout_rmse_mm);
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace

std::string to_json(const Diagnosis& d) {
  Json json;
  json["schema"] = 1;
  json["verdict"] = name_of(d.verdict);
  json["causes"] = Json::array();
  json["alternatives"] = Json::array();
  for (const NamedCause& named : d.causes) {
    json["causes"].push_back(cause_json(named));
    Json ids = Json::array();
    for (const Cause& rival : named.rivals) ids.push_back(rival.id);
    json["alternatives"].push_back(std::move(ids));
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
  json["gain_percent"] = spread(d.gain);
  json["unexplained_percent"] = d.unexplained_percent;
  json["next_experiment"] = nullptr;
  json["partial_causes"] = Json::array();
  for (const NamedCause& named : d.partial) json["partial_causes"].push_back(cause_json(named));
  json["structure_mm"] = {{"recalibrated", d.structure_recalibrated.excess_mm},
                          {"left", d.structure_left.excess_mm}};
  Json candidates = Json::object();
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) {
      candidates[std::string(named.cause.id)] = candidates_json(named.candidates);
    }
  }
  if (!d.rejected.empty()) candidates["none"] = candidates_json(d.rejected);
  json["candidates"] = std::move(candidates);
  json["warnings"] = d.warnings;
  json["wall_s"] = d.wall_s;
  return json.dump(2) + "\n";
}

}  // namespace softgrip::sysid
