#include "sysid/health/health_page.h"

#include <algorithm>
#include <map>

#include "base/numbers.h"
#include "sysid/changes/next_steps.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/experiments/experiment_advice.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid::health {
namespace {

using sysid::HealthNumber;
using sysid::HealthSign;
using sysid::Moves;

/// Penalties in the score of a cause: one for each of its signs that is missing although the indicator has a
/// reference, and one for each change that the cause does not explain. Each sign that is present adds 1 to
/// the score.
constexpr double missing_sign = 0.25;
constexpr double unexplained_alarm = 1 - missing_sign;
/// Penalty of a cause that can be diagnosed only from recordings with an additional column. Recordings of
/// grips may lack this column.
constexpr double lacks_column = 0.05;
/// A cause is a candidate only if its score is at most this much below the best score.
constexpr double as_much = 0.1;

bool agrees(Moves moves, double change) {
  if (moves == Moves::either_way) return true;
  return moves == (change > 0 ? Moves::up : Moves::down);
}

/// Returns the changes of the indicators in alarm, and the shared changes that started no later than the
/// latest of these alarms. Every change of a finger affects the time to grip. A change of the time to grip is
/// therefore included only if no other indicator has changed.
std::map<HealthNumber, double> changes_of(const FingerHealth& health,
                                          const std::vector<SharedChange>& shared) {
  std::map<HealthNumber, double> changes;
  std::string latest;
  for (const HealthAlarm& alarm : health.standing()) {
    changes[alarm.number] = alarm.change;
    latest = std::max(latest, health.points[alarm.since].label);
  }
  for (const SharedChange& one : shared) {
    if (one.stands && !changes.empty() && one.since <= latest) changes.emplace(one.number, one.change);
  }
  if (changes.size() > 1) changes.erase(HealthNumber::time_to_grip);
  return changes;
}

/// Returns the score of a cause that has these signs: the number of present signs minus the penalties.
/// Returns 0 if no sign is present.
double explained(const sysid::HealthSigns& signs, const std::map<HealthNumber, double>& changes,
                 const FingerHealth& health) {
  double worth = 0;
  std::size_t hits = 0;
  for (const HealthSign& sign : signs) {
    if (sign.moves == Moves::not_at_all) continue;
    const auto change = changes.find(sign.number);
    const bool seen = change != changes.end() && agrees(sign.moves, change->second);
    const bool judged = health.references[static_cast<std::size_t>(sign.number)].has_value();
    hits += seen ? 1 : 0;
    worth += seen ? 1 : judged ? -missing_sign : 0;
  }
  const auto unexplained = static_cast<double>(changes.size() - hits);
  return hits == 0 ? 0 : worth - unexplained_alarm * unexplained;
}

/// Returns true if the reference of an indicator in alarm depends on the temperature.
bool allows_for_temperature(const FingerHealth& health) {
  const std::vector<HealthAlarm> alarms = health.standing();
  return std::any_of(alarms.begin(), alarms.end(), [&](const HealthAlarm& alarm) {
    const auto& reference = health.references[static_cast<std::size_t>(alarm.number)];
    return reference && reference->slope;
  });
}

std::string sentence_without_alarm(const FingerHealth& health) {
  if (health.latest(HealthNumber::gain) || health.latest(HealthNumber::lag))
    return "No indicator has changed at " + name_in_text(health) + ".";
  return "No grip of " + name_in_text(health) +
         " contains enough free motion for the gain and the lag, so a change of them cannot be detected. The "
         "other indicators have not changed.";
}

}  // namespace

Suspicion suspicion_of(const FingerHealth& health, const std::vector<SharedChange>& shared) {
  const std::map<HealthNumber, double> changes = changes_of(health, shared);
  std::vector<std::pair<double, std::string_view>> found;
  for (const std::string_view id : sysid::changes()) {
    const double worth = explained(sysid::signs_of(id), changes, health);
    const auto cause = sysid::find_cause(id);
    if (cause && cause->needs == sysid::Column::temperature_c && allows_for_temperature(health)) continue;
    const bool not_recorded = cause && cause->needs != sysid::Column::none;
    if (worth > 0) found.emplace_back(not_recorded ? worth - lacks_column : worth, id);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Suspicion suspicion;
  for (const auto& [worth, id] : found) {
    if (worth < found.front().first - as_much || suspicion.suspects.size() == limits::most_alternatives)
      break;
    const auto steps = sysid::next_steps(id);
    suspicion.suspects.push_back({std::string(id),
                                  std::string(sysid::plain_words(id)),
                                  {std::string(steps[0]), std::string(steps[1])}});
  }
  const auto measured = static_cast<std::size_t>(HealthNumber::pressure_loss);
  for (std::size_t i = 1; i < suspicion.suspects.size(); ++i) {
    sysid::AdviceFacts facts;
    facts.separable = true;
    facts.temperature_varies = health.points.back().temperature_c.has_value();
    facts.pressure_recorded = health.references[measured].has_value();
    for (std::string& advice :
         sysid::advice_for(suspicion.suspects.front().id, suspicion.suspects[i].id, facts)) {
      if (std::find(suspicion.advice.begin(), suspicion.advice.end(), advice) == suspicion.advice.end())
        suspicion.advice.push_back(std::move(advice));
    }
  }
  return suspicion;
}

std::string health_sentence(const FingerHealth& health, const Suspicion& suspicion) {
  const std::vector<HealthAlarm> alarms = health.standing();
  if (health.state == FingerState::learning)
    return "There are too few grips to determine the reference values of " + name_in_text(health) + ".";
  if (alarms.empty()) return sentence_without_alarm(health);
  std::string sentence = (health.finger.empty() ? "The finger" : health.finger) + " has changed since " +
                         health.points[alarms.front().since].label + ": ";
  for (std::size_t i = 0; i < alarms.size(); ++i)
    sentence += (i > 0 ? ", " : "") + change_text(alarms[i].number, alarms[i].change, health.output_unit);
  if (suspicion.suspects.empty()) return sentence + ". No known cause has this combination of changes.";
  sentence += ". Possible cause: " + suspicion.suspects.front().words;
  for (std::size_t i = 1; i < suspicion.suspects.size(); ++i)
    sentence += ", or " + suspicion.suspects[i].words;
  return sentence + ".";
}

}  // namespace softgrip::sysid::health
