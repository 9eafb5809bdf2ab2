#include "sysid/health/rig_health.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/health/number_watch.h"

namespace softgrip::sysid::health {

RigHealth judge_rig(std::vector<FingerRuns> fingers, const std::vector<Note>& notes,
                    const HealthOptions& options) {
  std::vector<FingerTrack> tracks;
  for (FingerRuns& finger : fingers) {
    std::stable_sort(finger.runs.begin(), finger.runs.end(),
                     [](const ScoredRun& a, const ScoredRun& b) { return a.started_at < b.started_at; });
    tracks.push_back(track_of(finger.finger, finger.runs, notes, finger.base, options.by_day));
  }
  const std::size_t moments = place_in_time(tracks);
  RigHealth rig;
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    for (SharedChange& shared : NumberWatch(i, tracks, options).run(moments))
      rig.shared.push_back(std::move(shared));
  }
  // A change of one finger changes the time to grip of all fingers. If a finger has an alarm, a shared change
  // of the time to grip is therefore only a consequence of this alarm's cause.
  const bool alarm = std::any_of(tracks.begin(), tracks.end(), [](const FingerTrack& track) {
    return track.health.state == FingerState::alarm;
  });
  for (SharedChange& shared : rig.shared) {
    if (shared.number == sysid::HealthNumber::time_to_grip && alarm) shared.stands = false;
  }
  for (FingerTrack& track : tracks) {
    std::stable_sort(track.health.alarms.begin(), track.health.alarms.end(),
                     [](const HealthAlarm& a, const HealthAlarm& b) { return a.noticed < b.noticed; });
    rig.fingers.push_back(std::move(track.health));
  }
  return rig;
}

FingerHealth judge_finger(const std::string& finger, std::vector<ScoredRun> runs,
                          const std::vector<Note>& notes, const ScoreBase& base,
                          const HealthOptions& options) {
  std::vector<FingerRuns> alone;
  alone.push_back({finger, std::move(runs), base});
  return std::move(judge_rig(std::move(alone), notes, options).fingers.front());
}

std::string change_text(sysid::HealthNumber number, double change, model::OutputUnit unit) {
  const sysid::HealthNumberInfo& info = sysid::info_of(number);
  return std::string(info.title) + (change > 0 ? " +" : " -") + significant(std::abs(change), 2) + " " +
         model::in_unit(info.unit, unit);
}

std::string unclear_sentence(const FingerHealth& health, const HealthAlarm& unclear) {
  return "Since " + health.points[unclear.since].label + ", the difference between " + name_in_text(health) +
         " and " + with_commas(unclear.beside) +
         " has changed: " + change_text(unclear.number, unclear.change, health.output_unit) +
         ". The indicators of the fingers do not yet show which finger has changed.";
}

std::string shared_sentence(const SharedChange& shared) {
  return "Since " + shared.since + ", all fingers of the rig show the same change: " +
         change_text(shared.number, shared.change, shared.output_unit) +
         ". First check what all fingers share: " +
         (shared.temperature_recorded ? "" : "the temperature (which is not recorded), ") +
         "the supply, the common air line and the gripped parts.";
}

}  // namespace softgrip::sysid::health
