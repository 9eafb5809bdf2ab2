#include "sysid/health/number_watch.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid::health {
namespace {

/// Smallest log likelihood ratio with which a change of the difference is attributed to a finger: odds of 20
/// to 1.
const double sure = std::log(20.0);
/// Maximum numbers of values of a finger that are averaged after a change, and before the change. If there
/// are more values, the most recent ones are used.
constexpr std::size_t points_since = 3, points_before = 10;

const RunningReference* longest(const ControlChart& chart) {
  const RunningReference* best = nullptr;
  for (const auto& [recipe, reference] : chart.references()) {
    if (best == nullptr || reference.count() > best->count()) best = &reference;
  }
  return best;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Returns true if two fingers have the same output unit and at least one common run.
bool have_a_run_in_common(const FingerTrack& one, const FingerTrack& other) {
  if (one.health.output_unit != other.health.output_unit) return false;
  return std::any_of(one.by_run.begin(), one.by_run.end(),
                     [&](const auto& run) { return other.by_run.contains(run.first); });
}

}  // namespace

NumberWatch::NumberWatch(std::size_t number, std::vector<FingerTrack>& tracks, const HealthOptions& options)
    : number_(number), tracks_(tracks), limits_(options.limits()) {
  have_runs_in_common_.resize(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    watched_.push_back({new_chart(i), new_chart(i)});
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      if (j != i && have_a_run_in_common(tracks[i], tracks[j])) have_runs_in_common_[i].push_back(j);
    }
  }
}

ControlChart NumberWatch::new_chart(std::size_t finger) const {
  return {limits_, least_difference(static_cast<sysid::HealthNumber>(number_), tracks_[finger].base)};
}

std::size_t NumberWatch::moment_of(std::size_t finger, std::size_t point) const {
  return tracks_[finger].groups[point].moment;
}

std::vector<SharedChange> NumberWatch::run(std::size_t moments) {
  for (std::size_t moment = 0; moment < moments; ++moment) {
    for (std::size_t i = 0; i < watched_.size(); ++i) add_own(i, moment);
    for (std::size_t i = 0; i < watched_.size(); ++i) add_beside(i, moment);
    decide(moment);
  }
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    FingerHealth& health = tracks_[i].health;
    const Watched& watched = watched_[i];
    if (!watched.alarm && watched.beside.alarm()) {
      health.unclear.push_back(alarm_of(i, true));
      health.unclear.back().noticed = health.unclear.back().warned;
    }
    if (watched.own.judged() > 0 && health.state == FingerState::learning) health.state = FingerState::steady;
    if (watched.alarm) health.state = FingerState::alarm;
    for (const auto& [recipe, reference] : watched.own.references()) {
      auto& known = health.references[number_];
      if (known && known->points >= reference.count()) continue;
      known =
          HealthReference{recipe, reference.mean(), reference.spread(), reference.count(), reference.slope()};
    }
    close(i);
  }
  return std::move(shared_);
}

void NumberWatch::add_own(std::size_t finger, std::size_t moment) {
  Watched& watched = watched_[finger];
  FingerHealth& health = tracks_[finger].health;
  for (; watched.next < health.points.size() && moment_of(finger, watched.next) == moment; ++watched.next) {
    HealthPoint& point = health.points[watched.next];
    if (point.epoch != watched.epoch) {
      close(finger);
      const std::size_t next = watched.next;
      watched = Watched{new_chart(finger), new_chart(finger)};
      watched.epoch = point.epoch;
      watched.next = next;
    }
    if (point.values[number_].empty()) continue;
    watched.own_at.push_back(watched.next);
    point.judged[number_] = watched.own.add(point.values[number_]);
    for (const auto& [recipe, reference] : watched.own.references()) {
      if (reference.slope()) watched.per_c[recipe] = reference.slope()->per_c;
    }
    if (const auto* reference = longest(watched.own))
      watched.widest_spread = std::max(watched.widest_spread, reference->spread());
  }
}

NumberWatch::PeerFingers NumberWatch::peers_of(std::size_t finger) const {
  PeerFingers peers;
  for (const std::size_t j : have_runs_in_common_[finger]) {
    if (!watched_[j].alarm) peers.emplace_back(j, watched_[j].epoch);
  }
  return peers;
}

std::vector<std::string> NumberWatch::names_of(const PeerFingers& peers) const {
  std::vector<std::string> names;
  for (const auto& [peer, epoch] : peers) names.push_back(tracks_[peer].health.finger);
  return names;
}

ChartValues NumberWatch::difference_at(std::size_t finger, std::size_t point,
                                       const PeerFingers& peers) const {
  struct Found {
    std::vector<double> differences, temperatures_c;
  };
  std::map<std::string, Found> recipes;
  for (const ScoredRun* run : tracks_[finger].groups[point].runs) {
    std::string key = run->recipe + " beside";
    std::vector<double> theirs;
    for (const auto& [peer, epoch] : peers) {
      const auto same = tracks_[peer].by_run.find(run->run);
      if (same == tracks_[peer].by_run.end() || same->second.epoch != epoch) continue;
      const double value = same->second.run->score.values[number_];
      if (!std::isfinite(value)) continue;
      theirs.push_back(value);
      key += " " + tracks_[peer].health.finger;
    }
    const double own = run->score.values[number_];
    if (theirs.empty() || !std::isfinite(own)) continue;
    Found& found = recipes[key];
    found.differences.push_back(own - mean_of(theirs));
    if (std::isfinite(run->temperature_c)) found.temperatures_c.push_back(run->temperature_c);
  }
  ChartValues values;
  for (auto& [key, found] : recipes) {
    const double at_c = found.temperatures_c.empty() ? RunningReference::no_temperature
                                                     : median_of(std::span<double>(found.temperatures_c));
    values.emplace(key, ChartValue(median_of(std::span<double>(found.differences)), at_c));
  }
  return values;
}

/// Replaces the peer fingers of the finger by `peers`, and starts a new control chart of the difference
/// between finger and peer fingers. Adds all points since the last maintenance record of the finger to the
/// new chart.
void NumberWatch::compare_again(std::size_t finger, PeerFingers peers) {
  note_differences(finger);
  Watched& watched = watched_[finger];
  watched.peers = std::move(peers);
  watched.beside = new_chart(finger);
  watched.beside_at.clear();
  for (const std::size_t point : points_of(finger)) {
    const ChartValues values = difference_at(finger, point, watched.peers);
    if (values.empty()) continue;
    watched.beside_at.push_back(point);
    (void)watched.beside.add(values);
  }
}

void NumberWatch::add_beside(std::size_t finger, std::size_t moment) {
  Watched& watched = watched_[finger];
  PeerFingers peers = peers_of(finger);
  if (peers != watched.peers) {
    // After an alarm of the finger, its chart with the earlier peer fingers is kept, because this chart may
    // have raised the alarm.
    if (!watched.alarm) compare_again(finger, std::move(peers));
    return;
  }
  if (watched.own_at.empty() || moment_of(finger, watched.own_at.back()) != moment) return;
  const std::size_t point = watched.own_at.back();
  if (!watched.beside_at.empty() && watched.beside_at.back() == point) return;
  const ChartValues values = difference_at(finger, point, watched.peers);
  if (values.empty()) return;
  watched.beside_at.push_back(point);
  (void)watched.beside.add(values);
}

std::vector<std::size_t> NumberWatch::points_of(std::size_t finger) const {
  const Watched& watched = watched_[finger];
  const std::vector<HealthPoint>& points = tracks_[finger].health.points;
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < watched.next; ++p) {
    if (points[p].epoch == watched.epoch && !points[p].values[number_].empty()) found.push_back(p);
  }
  return found;
}

std::optional<double> NumberWatch::moved(std::size_t finger, std::size_t from_moment) const {
  struct About {
    std::vector<double> before, since;
  };
  std::map<std::string, About> recipes;
  const std::vector<std::size_t> points = points_of(finger);
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    for (const auto& [recipe, value] : tracks_[finger].health.points[*point].values[number_]) {
      const auto slope = watched_[finger].per_c.find(recipe);
      const bool follows = slope != watched_[finger].per_c.end() && std::isfinite(value.temperature_c);
      const double cool = value.value - (follows ? slope->second * value.temperature_c : 0);
      About& about = recipes[recipe];
      if (moment_of(finger, *point) < from_moment) {
        if (about.before.size() < points_before) about.before.push_back(cool);
      } else if (about.since.size() < points_since) {
        about.since.push_back(cool);
      }
    }
  }
  std::vector<double> all;
  for (const auto& [recipe, about] : recipes) {
    if (!about.before.empty() && !about.since.empty())
      all.push_back(mean_of(about.since) - mean_of(about.before));
  }
  if (all.empty()) return std::nullopt;
  return mean_of(all);
}

std::optional<double> NumberWatch::peers_moved(std::size_t finger, std::size_t from_moment) const {
  std::vector<double> all;
  for (const auto& [peer, epoch] : peers_of(finger)) {
    if (const auto by = moved(peer, from_moment)) all.push_back(*by);
  }
  if (all.empty()) return std::nullopt;
  return mean_of(all);
}

double NumberWatch::usual_variance(std::size_t finger) const {
  const double least = least_difference(static_cast<sysid::HealthNumber>(number_), tracks_[finger].base);
  const RunningReference* const reference = longest(watched_[finger].own);
  const double spread = std::max(least, watched_[finger].widest_spread);
  double averaged = 2;
  if (reference != nullptr && reference->count() >= limits::fewest_for_correlation) {
    const double persistence = reference->persistence();
    averaged = std::min(averaged,
                        (1 + persistence) / (1 - persistence) * (1.0 / points_since + 1.0 / points_before));
  }
  return spread * spread * averaged;
}

std::optional<std::size_t> NumberWatch::changed_finger() const {
  std::optional<std::size_t> found;
  double most = sure;
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const Watched& watched = watched_[i];
    if (watched.alarm || !watched.beside.alarm()) continue;
    const std::size_t from = moment_of(i, watched.beside_at[watched.beside.alarm()->since]);
    const auto own = moved(i, from), theirs = peers_moved(i, from);
    if (!own || !theirs) continue;
    double variance = usual_variance(i);
    for (const auto& [peer, epoch] : watched.peers) variance = std::max(variance, usual_variance(peer));
    const double odds = (*own * *own - *theirs * *theirs) / (2 * variance);
    if (odds < most) continue;
    most = odds;
    found = i;
  }
  return found;
}

bool NumberWatch::is_shared(std::size_t finger) const {
  const Watched& watched = watched_[finger];
  const std::size_t from = moment_of(finger, watched.own_at[watched.own.alarm()->since]);
  const auto theirs = peers_moved(finger, from);
  return theirs && *theirs / watched.own.alarm()->change >= limits::majority_share;
}

void NumberWatch::decide(std::size_t moment) {
  while (const auto finger = changed_finger()) {
    raise(*finger, true);
    for (std::size_t i = 0; i < watched_.size(); ++i) add_beside(i, moment);
  }
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    if (watched_[i].alarm || !watched_[i].own.alarm()) continue;
    if (is_shared(i)) {
      share(i);
    } else {
      raise(i, false);
      for (std::size_t j = 0; j < watched_.size(); ++j) add_beside(j, moment);
    }
  }
}

HealthAlarm NumberWatch::alarm_of(std::size_t finger, bool beside) const {
  const Watched& watched = watched_[finger];
  const ChartAlarm& told = beside ? *watched.beside.alarm() : *watched.own.alarm();
  const std::vector<std::size_t>& at = beside ? watched.beside_at : watched.own_at;
  HealthAlarm alarm{static_cast<sysid::HealthNumber>(number_),
                    watched.epoch,
                    at.back(),
                    at[told.since],
                    told.change,
                    0,
                    {},
                    at.back()};
  if (beside) alarm.beside = names_of(watched.peers);
  if (watched.beside.alarm()) alarm.warned = watched.beside_at[watched.beside.alarm()->noticed];
  for (std::size_t p = alarm.since; p <= alarm.noticed; ++p)
    alarm.grips += tracks_[finger].health.points[p].grips;
  return alarm;
}

void NumberWatch::raise(std::size_t finger, bool beside) {
  Watched& watched = watched_[finger];
  watched.alarm = alarm_of(finger, beside);
  // The reference of the finger must contain only values from before the change.
  const auto first = std::lower_bound(watched.own_at.begin(), watched.own_at.end(), watched.alarm->since);
  watched.own.take_alarm(static_cast<std::size_t>(first - watched.own_at.begin()));
}

void NumberWatch::share(std::size_t finger) {
  Watched& watched = watched_[finger];
  FingerHealth& health = tracks_[finger].health;
  const ChartAlarm told = *watched.own.alarm();
  const bool is_first = shared_.empty() || !shared_.back().stands ||
                        shared_.back().change * told.change < 0 ||
                        (watched.shared && *watched.shared == shared_.size() - 1);
  if (is_first) {
    if (!shared_.empty()) shared_.back().stands = false;
    const HealthPoint& noticed = health.points[watched.own_at.back()];
    shared_.push_back({static_cast<sysid::HealthNumber>(number_),
                       told.change,
                       health.points[watched.own_at[told.since]].label,
                       noticed.label,
                       {},
                       noticed.temperature_c.has_value(),
                       true,
                       health.output_unit});
  }
  shared_.back().fingers.push_back(health.finger);
  watched.shared = shared_.size() - 1;
  // The values since the shared change become the new reference.
  watched.own_at.erase(watched.own_at.begin(),
                       watched.own_at.begin() + static_cast<std::ptrdiff_t>(told.since));
  watched.own = new_chart(finger);
  for (const std::size_t point : watched.own_at) (void)watched.own.add(health.points[point].values[number_]);
}

void NumberWatch::note_differences(std::size_t finger) {
  const Watched& watched = watched_[finger];
  for (std::size_t i = 0; i < watched.beside_at.size(); ++i)
    tracks_[finger].health.points[watched.beside_at[i]].beside[number_] = watched.beside.excess(i);
}

void NumberWatch::close(std::size_t finger) {
  note_differences(finger);
  Watched& watched = watched_[finger];
  FingerHealth& health = tracks_[finger].health;
  if (watched.epoch != health.epoch()) {
    for (SharedChange& shared : shared_) {
      if (std::find(shared.fingers.begin(), shared.fingers.end(), health.finger) != shared.fingers.end())
        shared.stands = false;
    }
  }
  if (!watched.alarm) return;
  // The size of the change is computed from the points after its detection, too.
  const auto& now = watched.alarm->beside.empty() ? watched.own.alarm() : watched.beside.alarm();
  if (now) watched.alarm->change = now->change;
  health.alarms.push_back(*watched.alarm);
}

}  // namespace softgrip::sysid::health
