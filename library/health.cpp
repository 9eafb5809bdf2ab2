#include "library/include/softgrip/health.h"

#include <limits>
#include <utility>

#include "base/clock.h"
#include "base/files.h"
#include "base/result/result.h"
#include "library/model_parts.h"
#include "sysid/health/health_result.h"

namespace softgrip {
namespace {

std::vector<sysid::health::Note> notes_of(const std::string& path) {
  if (path.empty()) return {};
  document::Problems problems;
  auto notes = sysid::health::load_notes(path, problems);
  if (!notes && !notes.error().empty()) throw FileError(notes.error());
  if (!notes) library::refuse(problems);
  return *std::move(notes);
}

HealthIndicator indicator_of(const sysid::health::FingerHealth& finger, std::size_t i) {
  const sysid::HealthNumberInfo& info = sysid::health_number_infos[i];
  const auto number = static_cast<sysid::HealthNumber>(i);
  HealthIndicator indicator{std::string(info.id),
                            std::string(info.title),
                            model::in_unit(info.unit, finger.output_unit),
                            finger.latest(number),
                            {},
                            {},
                            {}};
  const auto& reference = finger.references[i];
  if (reference) {
    indicator.reference = reference->mean;
    if (reference->points > 1) indicator.spread = reference->spread;
  }
  for (const sysid::health::HealthPoint& point : finger.points) {
    const sysid::health::ChartValues& values = point.values[i];
    const auto of_recipe = reference ? values.find(reference->recipe) : values.begin();
    indicator.values.push_back(of_recipe == values.end() ? std::numeric_limits<double>::quiet_NaN()
                                                         : of_recipe->second.value);
  }
  return indicator;
}

FingerHealth finger_of(const sysid::health::JudgedFinger& judged) {
  const sysid::health::FingerHealth& from = judged.health;
  FingerHealth finger;
  finger.finger = from.finger;
  finger.state = sysid::health::name_of(from.state);
  finger.sentence = health_sentence(from, judged.suspicion);
  finger.unit = library::unit_of(from.output_unit);
  for (const sysid::health::HealthPoint& point : from.points) {
    finger.grips += point.grips;
    finger.points.push_back(point.label);
  }
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) finger.indicators.push_back(indicator_of(from, i));
  for (const sysid::health::HealthAlarm& alarm : from.alarms)
    finger.alarms.push_back({std::string(sysid::info_of(alarm.number).id), alarm.change,
                             from.points[alarm.since].label, from.points[alarm.noticed].label, alarm.grips,
                             alarm.epoch == from.epoch()});
  for (const sysid::health::Suspect& suspect : judged.suspicion.suspects)
    finger.suspects.push_back({suspect.id, suspect.words, suspect.next_steps});
  finger.advice = judged.suspicion.advice;
  finger.html = health_page(from, judged.suspicion, judged.source).to_html();
  return finger;
}

[[noreturn]] void refuse(const sysid::health::HealthRefusal& refusal) {
  if (!refusal.notes.empty()) library::refuse(refusal.notes);
  const sysid::health::RefusedBaseline& baseline = refusal.baselines.front();
  if (baseline.why.empty()) library::refuse(baseline.problems);
  throw FileError(baseline.why);
}

}  // namespace

Health health(const std::vector<std::string>& recordings, const std::string& baseline,
              const HealthOptions& options) {
  if (recordings.empty())
    throw InvalidArgument("recordings", "0 paths were given; at least 1 path is required");
  if (baseline.empty())
    throw InvalidArgument("baseline", "a path is empty; the path of a folder is required");
  library::require_between("false_alarm_points", options.false_alarm_points, 20, 1e9, "");
  sysid::health::HealthQuestion question{recordings, baseline, notes_of(options.notes),
                                         {},         {},       options.progress};
  question.options.false_alarm_points = options.false_alarm_points;
  question.options.by_day = options.points == HealthPoints::day;
  if (!options.scores.empty()) {
    auto earlier = sysid::health::earlier_scores(options.scores);
    if (!earlier) throw FileError(earlier.error());
    question.scores = *std::move(earlier);
  }
  const auto found =
      library::cancellable(1, options.stop, [&] { return sysid::health::recorded_health(question); });
  if (!found) refuse(found.error());
  if (found->fingers.empty()) {
    std::string reason = "no recording can be compared with the baseline " + baseline;
    if (!found->skipped.empty())
      reason += ". " + found->skipped.front().run + ": " + found->skipped.front().why;
    throw Refused(reason);
  }
  if (!options.scores.empty()) {
    if (const auto written = write_file(options.scores, found->scores); !written)
      throw FileError(written.error());
  }
  Health result;
  result.alarm = found->alarm();
  for (const sysid::health::JudgedFinger& judged : found->fingers)
    result.fingers.push_back(finger_of(judged));
  result.warnings = sysid::health::warnings_of(*found);
  for (const sysid::health::SkippedRun& skipped : found->skipped)
    result.skipped.push_back({skipped.run, skipped.why});
  result.json = result::json_text(sysid::health::fields_of(*found, wall_time_now()));
  return result;
}

}  // namespace softgrip
