#include "sysid/health/health_json.h"

#include <nlohmann/json.hpp>

namespace softgrip::sysid::health {
namespace {

using Json = nlohmann::ordered_json;

Json json_of_alarm(const FingerHealth& health, const HealthAlarm& alarm) {
  return {{"number", sysid::info_of(alarm.number).id},  {"change", alarm.change},
          {"since", health.points[alarm.since].label},  {"noticed", health.points[alarm.noticed].label},
          {"grips_until_noticed", alarm.grips},         {"active", alarm.epoch == health.epoch()},
          {"stands", alarm.epoch == health.epoch()},    {"beside", alarm.beside},
          {"warned", health.points[alarm.warned].label}};
}

Json json_of_number(const FingerHealth& health, std::size_t i) {
  Json number{{"value", nullptr}, {"reference", nullptr}, {"spread", nullptr}, {"points", 0},
              {"z", nullptr},     {"beside", nullptr},    {"per_c", nullptr}};
  if (const auto value = health.latest(static_cast<sysid::HealthNumber>(i))) number["value"] = *value;
  if (const auto& reference = health.references[i]) {
    number["reference"] = reference->mean;
    if (reference->points > 1) number["spread"] = reference->spread;
    number["points"] = reference->points;
    number["recipe"] = reference->recipe;
    if (const auto& slope = reference->slope) {
      number["per_c"] = slope->per_c;
      number["per_c_error"] = slope->standard_error;
      number["seen_c"] = {slope->lowest_c, slope->highest_c};
    }
  }
  for (auto point = health.points.rbegin(); point != health.points.rend(); ++point) {
    if (point->values[i].empty()) continue;
    if (point->judged[i]) number["z"] = *point->judged[i];
    if (point->beside[i]) number["beside"] = *point->beside[i];
    break;
  }
  return number;
}

}  // namespace

Json json_of(const FingerHealth& health, const Suspicion& suspicion) {
  std::size_t grips = 0;
  for (const HealthPoint& point : health.points) grips += point.grips;
  Json finger{{"finger", health.finger},
              {"state", name_of(health.state)},
              {"output_unit", model::name_of(health.output_unit)},
              {"sentence", health_sentence(health, suspicion)},
              {"grips", grips},
              {"points", health.points.size()},
              {"first", health.points.empty() ? Json(nullptr) : Json(health.points.front().label)},
              {"last", health.points.empty() ? Json(nullptr) : Json(health.points.back().label)}};
  const bool warm = !health.points.empty() && health.points.back().temperature_c.has_value();
  finger["temperature_c"] = warm ? Json(*health.points.back().temperature_c) : Json(nullptr);
  finger["numbers"] = Json::object();
  for (std::size_t i = 0; i < sysid::health_numbers; ++i)
    finger["numbers"][std::string(sysid::health_number_infos[i].id)] = json_of_number(health, i);
  finger["alarms"] = Json::array();
  for (const HealthAlarm& alarm : health.alarms) finger["alarms"].push_back(json_of_alarm(health, alarm));
  finger["unclear"] = Json::array();
  for (const HealthAlarm& unclear : health.unclear)
    finger["unclear"].push_back(json_of_alarm(health, unclear));
  finger["suspects"] = Json::array();
  for (const Suspect& suspect : suspicion.suspects)
    finger["suspects"].push_back(
        {{"id", suspect.id}, {"words", suspect.words}, {"next_steps", suspect.next_steps}});
  finger["advice"] = suspicion.advice;
  finger["notes"] = Json::array();
  for (const auto& [before, note] : health.notes)
    finger["notes"].push_back({{"date", note.date}, {"action", note.action}, {"mended", note.action}});
  return finger;
}

Json json_of(const SharedChange& shared) {
  return {{"number", sysid::info_of(shared.number).id},
          {"change", shared.change},
          {"output_unit", model::name_of(shared.output_unit)},
          {"since", shared.since},
          {"noticed", shared.noticed},
          {"fingers", shared.fingers},
          {"temperature_recorded", shared.temperature_recorded},
          {"active", shared.stands},
          {"stands", shared.stands}};
}

}  // namespace softgrip::sysid::health
