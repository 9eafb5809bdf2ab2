#include "sysid/health/finger_track.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <string_view>
#include <utility>

#include "base/statistics.h"

namespace softgrip::sysid::health {
namespace {

/// Number of characters of the date in "2026-11-22T14:30:00Z".
constexpr std::size_t day_letters = std::string_view("2026-11-22").size();

std::size_t epoch_of(const ScoredRun& run, const std::vector<Note>& notes) {
  if (run.started_at.empty()) return 0;
  return static_cast<std::size_t>(std::count_if(
      notes.begin(), notes.end(), [&](const Note& note) { return note.date <= run.started_at; }));
}

std::vector<RunGroup> grouped(const std::vector<ScoredRun>& runs, const std::vector<Note>& notes,
                              bool by_day) {
  std::vector<RunGroup> groups;
  for (const ScoredRun& run : runs) {
    const bool dated = by_day && run.started_at.size() >= day_letters;
    const std::string label = dated ? run.started_at.substr(0, day_letters) : run.run;
    const std::size_t epoch = epoch_of(run, notes);
    const bool goes_on =
        dated && !groups.empty() && groups.back().label == label && groups.back().epoch == epoch;
    if (!goes_on) groups.push_back({label, epoch, {}, 0});
    groups.back().runs.push_back(&run);
  }
  return groups;
}

/// Returns the median of the known temperatures; NaN if no run has one.
double median_of_known(const std::vector<const ScoredRun*>& runs) {
  std::vector<double> known;
  for (const ScoredRun* run : runs) {
    if (std::isfinite(run->temperature_c)) known.push_back(run->temperature_c);
  }
  return known.empty() ? RunningReference::no_temperature : median_of(std::span<double>(known));
}

HealthPoint point_of(const RunGroup& group) {
  HealthPoint point;
  point.label = group.label;
  point.grips = group.runs.size();
  point.epoch = group.epoch;
  if (const double temperature_c = median_of_known(group.runs); std::isfinite(temperature_c))
    point.temperature_c = temperature_c;
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    std::map<std::string, std::vector<const ScoredRun*>> recipes;
    for (const ScoredRun* run : group.runs) {
      if (std::isfinite(run->score.values[i])) recipes[run->recipe].push_back(run);
    }
    for (const auto& [recipe, runs] : recipes) {
      std::vector<double> found;
      for (const ScoredRun* run : runs) found.push_back(run->score.values[i]);
      point.values[i].emplace(recipe, ChartValue(median_of(std::span<double>(found)), median_of_known(runs)));
    }
  }
  return point;
}

}  // namespace

FingerTrack track_of(const std::string& finger, const std::vector<ScoredRun>& runs,
                     const std::vector<Note>& notes, const ScoreBase& base, bool by_day) {
  FingerTrack track;
  track.health.finger = finger;
  track.health.output_unit = base.model.output_unit;
  track.base = base;
  std::vector<Note> own;
  for (const Note& note : notes) {
    if (note.finger.empty() || note.finger == finger) own.push_back(note);
  }
  track.groups = grouped(runs, own, by_day);
  for (const RunGroup& group : track.groups) {
    track.health.points.push_back(point_of(group));
    for (const ScoredRun* run : group.runs) track.by_run[run->run] = {run, group.epoch};
  }
  const std::vector<HealthPoint>& points = track.health.points;
  for (std::size_t n = 0; n < own.size(); ++n) {
    std::size_t before = 0;
    while (before < points.size() && points[before].epoch <= n) ++before;
    track.health.notes.emplace_back(before, own[n]);
  }
  return track;
}

std::size_t place_in_time(std::vector<FingerTrack>& tracks) {
  struct Moment {
    std::string begin;
    std::size_t index = 0;
  };
  // The order of the labels agrees with the order in each track. A run that only one finger has is placed
  // before the next run of this finger.
  std::list<Moment> in_order;
  std::map<std::string, std::list<Moment>::iterator> places;
  for (const FingerTrack& track : tracks) {
    auto next = in_order.end();
    for (auto group = track.groups.rbegin(); group != track.groups.rend(); ++group) {
      const std::string& begin = group->runs.front()->started_at;
      const auto [place, is_new] = places.try_emplace(group->label);
      if (is_new) place->second = in_order.insert(next, Moment{begin});
      next = place->second;
      next->begin = std::min(next->begin, begin);
    }
  }
  in_order.sort([](const Moment& a, const Moment& b) { return a.begin < b.begin; });
  std::size_t moments = 0;
  for (Moment& one : in_order) one.index = moments++;
  for (FingerTrack& track : tracks) {
    for (RunGroup& group : track.groups) group.moment = places.at(group.label)->index;
  }
  return moments;
}

}  // namespace softgrip::sysid::health
