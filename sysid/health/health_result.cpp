#include "sysid/health/health_result.h"

#include <algorithm>

#include "base/clock.h"
#include "base/version.h"

namespace softgrip::sysid::health {
namespace {

using result::Fields, result::list_of, result::number, result::shown, result::Value;

/// Returns the ids of two groups of indicators. The indicators of the first group have an active alarm in the
/// same direction at every finger. For the indicators of the second group, `rig` contains an active change
/// that several fingers share.
std::vector<std::string> shared_numbers(const RecordedHealth& rig) {
  std::vector<const FingerHealth*> all;
  for (const JudgedFinger& finger : rig.fingers) all.push_back(&finger.health);
  std::vector<std::string> ids;
  for (const HealthNumber number : shared_changes(all)) ids.emplace_back(info_of(number).id);
  for (const SharedChange& shared : rig.shared) {
    if (shared.stands && std::find(ids.begin(), ids.end(), info_of(shared.number).id) == ids.end())
      ids.emplace_back(info_of(shared.number).id);
  }
  return ids;
}

Fields fields_of_suspect(const Suspect& suspect) {
  return {{"id", suspect.id}, {"words", suspect.words}, {"next_steps", suspect.next_steps}};
}

}  // namespace

Fields alarm_fields(const FingerHealth& health, const HealthAlarm& alarm) {
  const HealthNumberInfo& info = info_of(alarm.number);
  const bool active = alarm.epoch == health.epoch();
  return {{"number", "indicator", shown(info.id, std::string(info.title))},
          {"change", "change", number(alarm.change, 3, model::in_unit(info.unit, health.output_unit))},
          {"since", "since", health.points[alarm.since].label},
          {"noticed", "noticed", health.points[alarm.noticed].label},
          {"grips_until_noticed", "grips until the detection", alarm.grips},
          {"active", "active", active},
          {"stands", active},
          {"beside", alarm.beside},
          {"warned", health.points[alarm.warned].label}};
}

Fields number_fields(const FingerHealth& health, std::size_t i) {
  const HealthNumberInfo& info = health_number_infos[i];
  const auto& reference = health.references[i];
  const auto of_reference = [&](auto part, bool known) {
    return known ? std::optional((*reference).*part) : std::nullopt;
  };
  const auto point = std::find_if(health.points.rbegin(), health.points.rend(),
                                  [&](const HealthPoint& one) { return !one.values[i].empty(); });
  const bool measured = point != health.points.rend();
  const bool slope = reference && reference->slope;
  Fields fields{{"", "indicator", info.title},
                {"value", "latest", health.latest(static_cast<HealthNumber>(i))},
                {"reference", "reference", of_reference(&HealthReference::mean, reference.has_value())},
                {"spread", "standard deviation",
                 number(of_reference(&HealthReference::spread, reference && reference->points > 1), 2)},
                {"points", "points", reference ? reference->points : 0},
                {"", "unit", model::in_unit(info.unit, health.output_unit)},
                {"z", measured ? point->judged[i] : std::nullopt},
                {"beside", measured ? point->beside[i] : std::nullopt},
                {"per_c", slope ? Value(reference->slope->per_c) : Value()}};
  if (reference) fields.emplace_back("recipe", reference->recipe);
  if (slope) {
    fields.emplace_back("per_c_error", reference->slope->standard_error);
    fields.emplace_back("seen_c", Value::List{reference->slope->lowest_c, reference->slope->highest_c});
  }
  return fields;
}

Fields fields_of(const FingerHealth& health, const Suspicion& suspicion) {
  std::size_t grips = 0;
  for (const HealthPoint& point : health.points) grips += point.grips;
  const HealthPoint* const first = health.points.empty() ? nullptr : &health.points.front();
  const HealthPoint* const last = health.points.empty() ? nullptr : &health.points.back();
  Fields numbers;
  for (std::size_t i = 0; i < health_numbers; ++i)
    numbers.emplace_back(std::string(health_number_infos[i].id), number_fields(health, i));
  const auto of_alarm = [&](const HealthAlarm& alarm) { return alarm_fields(health, alarm); };
  return {{"finger", health.finger},
          {"state", name_of(health.state)},
          {"output_unit", model::name_of(health.output_unit)},
          {"sentence", health_sentence(health, suspicion)},
          {"grips", grips},
          {"points", health.points.size()},
          {"first", first ? Value(first->label) : Value()},
          {"last", last ? Value(last->label) : Value()},
          {"temperature_c", last ? last->temperature_c : std::nullopt},
          {"numbers", std::move(numbers)},
          {"alarms", list_of(health.alarms, of_alarm)},
          {"unclear", list_of(health.unclear, of_alarm)},
          {"suspects", list_of(suspicion.suspects, fields_of_suspect)},
          {"advice", suspicion.advice},
          {"notes", list_of(health.notes, [](const auto& placed) -> Fields {
             const Note& note = placed.second;
             return {{"date", note.date}, {"action", note.action}, {"mended", note.action}};
           })}};
}

Fields fields_of(const SharedChange& shared) {
  return {{"number", info_of(shared.number).id},
          {"change", shared.change},
          {"output_unit", model::name_of(shared.output_unit)},
          {"since", shared.since},
          {"noticed", shared.noticed},
          {"fingers", shared.fingers},
          {"temperature_recorded", shared.temperature_recorded},
          {"active", shared.stands},
          {"stands", shared.stands}};
}

Fields fields_of(const RecordedHealth& health, Nanoseconds now) {
  const ChartLimits limits = health.options.limits();
  return {
      {"schema", 1},
      {"made", utc_text(now)},
      {"made_unix_s", now / 1'000'000'000},
      {"software_version", software_version()},
      {"baseline", health.baseline},
      {"state", health.alarm() ? "alarm" : "steady"},
      {"false_alarm_points", health.options.false_alarm_points},
      {"limits", Fields{{"allowance", limits.allowance}, {"cusum", limits.cusum}, {"single", limits.single}}},
      {"fingers",
       list_of(health.fingers, [](const JudgedFinger& one) { return fields_of(one.health, one.suspicion); })},
      {"shared", shared_numbers(health)},
      {"shared_changes", list_of(health.shared)},
      {"warnings", warnings_of(health)},
      {"skipped", list_of(health.skipped, [](const SkippedRun& one) -> Fields {
         Fields fields{{"run", one.run}, {"why", one.why}};
         if (!one.finger.empty()) fields.emplace_back("finger", one.finger);
         return fields;
       })}};
}

}  // namespace softgrip::sysid::health
