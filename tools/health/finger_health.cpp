#include "tools/health/finger_health.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/statistics.h"

namespace softgrip::tools::health {
namespace {

constexpr std::size_t day_letters = 10;  // of "2026-11-22T14:30:00Z"

/// Runs in one point.
struct Group {
  std::string label;
  std::size_t epoch = 0;
  std::vector<const ScoredRun*> runs;
};

std::size_t epoch_of(const ScoredRun& run, const std::vector<Note>& notes) {
  if (run.started_at.empty()) return 0;
  return static_cast<std::size_t>(std::count_if(
      notes.begin(), notes.end(), [&](const Note& note) { return note.date <= run.started_at; }));
}

std::vector<Group> grouped(const std::vector<ScoredRun>& runs, const std::vector<Note>& notes, bool by_day) {
  std::vector<Group> groups;
  for (const ScoredRun& run : runs) {
    const bool dated = by_day && run.started_at.size() >= day_letters;
    const std::string label = dated ? run.started_at.substr(0, day_letters) : run.run;
    const std::size_t epoch = epoch_of(run, notes);
    const bool goes_on =
        dated && !groups.empty() && groups.back().label == label && groups.back().epoch == epoch;
    if (!goes_on) groups.push_back({label, epoch, {}});
    groups.back().runs.push_back(&run);
  }
  return groups;
}

HealthPoint point_of(const Group& group) {
  HealthPoint point;
  point.label = group.label;
  point.grips = group.runs.size();
  point.epoch = group.epoch;
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    std::map<std::string, std::vector<double>> values;
    for (const ScoredRun* run : group.runs) {
      if (std::isfinite(run->score.values[i])) values[run->recipe].push_back(run->score.values[i]);
    }
    for (auto& [recipe, found] : values) point.values[i][recipe] = median_of(std::span<double>(found));
  }
  return point;
}

/// One number through all epochs.
class Follower {
 public:
  Follower(std::size_t number, const ScoreBase& base, const HealthOptions& options)
      : number_(number),
        limits_(options.limits()),
        least_(least_difference(static_cast<sysid::HealthNumber>(number), base)),
        chart_(limits_, least_) {}

  void run(FingerHealth& health) {
    for (std::size_t p = 0; p < health.points.size(); ++p) {
      HealthPoint& point = health.points[p];
      if (p > 0 && point.epoch != health.points[p - 1].epoch) {
        keep_alarm(health, health.points[p - 1].epoch);
        chart_ = ControlChart(limits_, least_);
        at_.clear();
      }
      if (point.values[number_].empty()) continue;
      at_.push_back(p);
      point.judged[number_] = chart_.add(point.values[number_]);
    }
    keep_alarm(health, health.epoch());
    note_reference(health);
    if (chart_.judged() > 0 && health.state == FingerState::learning) health.state = FingerState::steady;
    if (chart_.alarm()) health.state = FingerState::alarm;
  }

 private:
  void keep_alarm(FingerHealth& health, std::size_t epoch) const {
    if (!chart_.alarm()) return;
    HealthAlarm alarm{static_cast<sysid::HealthNumber>(number_),
                      epoch,
                      at_[chart_.alarm()->noticed],
                      at_[chart_.alarm()->since],
                      chart_.alarm()->change,
                      0};
    for (std::size_t p = alarm.since; p <= alarm.noticed; ++p) alarm.grips += health.points[p].grips;
    health.alarms.push_back(alarm);
  }
  void note_reference(FingerHealth& health) const {
    for (const auto& [recipe, reference] : chart_.references()) {
      auto& known = health.references[number_];
      if (known && known->points >= reference.count()) continue;
      known = HealthReference{recipe, reference.mean(), reference.spread(), reference.count()};
    }
  }

  std::size_t number_;
  ChartLimits limits_;
  double least_;
  ControlChart chart_;
  std::vector<std::size_t> at_;  ///< the health's point of each of the chart's
};

}  // namespace

const char* name_of(FingerState state) {
  if (state == FingerState::alarm) return "alarm";
  return state == FingerState::steady ? "steady" : "learning";
}

std::vector<HealthAlarm> FingerHealth::standing() const {
  std::vector<HealthAlarm> now;
  for (const HealthAlarm& alarm : alarms) {
    if (alarm.epoch == epoch()) now.push_back(alarm);
  }
  return now;
}

std::optional<double> FingerHealth::latest(sysid::HealthNumber number) const {
  const auto i = static_cast<std::size_t>(number);
  const std::string recipe = references[i] ? references[i]->recipe : std::string();
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    const ChartValues& values = point->values[i];
    if (values.empty()) continue;
    const auto same = values.find(recipe);
    return same != values.end() ? same->second : values.begin()->second;
  }
  return std::nullopt;
}

FingerHealth judge_finger(const std::string& finger, std::vector<ScoredRun> runs,
                          const std::vector<Note>& notes, const ScoreBase& base,
                          const HealthOptions& options) {
  FingerHealth health;
  health.finger = finger;
  std::vector<Note> own;
  for (const Note& note : notes) {
    if (note.finger.empty() || note.finger == finger) own.push_back(note);
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [](const ScoredRun& a, const ScoredRun& b) { return a.started_at < b.started_at; });
  for (const Group& group : grouped(runs, own, options.by_day)) health.points.push_back(point_of(group));
  for (std::size_t n = 0; n < own.size(); ++n) {
    std::size_t before = 0;
    while (before < health.points.size() && health.points[before].epoch <= n) ++before;
    health.notes.emplace_back(before, own[n]);
  }
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) Follower(i, base, options).run(health);
  std::stable_sort(health.alarms.begin(), health.alarms.end(),
                   [](const HealthAlarm& a, const HealthAlarm& b) { return a.noticed < b.noticed; });
  return health;
}

std::vector<sysid::HealthNumber> shared_changes(const std::vector<const FingerHealth*>& fingers) {
  std::vector<sysid::HealthNumber> shared;
  if (fingers.size() < 2) return shared;
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    std::size_t up = 0, down = 0;
    for (const FingerHealth* finger : fingers) {
      for (const HealthAlarm& alarm : finger->standing()) {
        if (static_cast<std::size_t>(alarm.number) == i) ++(alarm.change > 0 ? up : down);
      }
    }
    if (std::max(up, down) == fingers.size()) shared.push_back(static_cast<sysid::HealthNumber>(i));
  }
  return shared;
}

}  // namespace softgrip::tools::health
