#pragma once
// Prepares the runs of a finger for the control charts: groups them into points, and orders the points of all
// fingers of a rig in time.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

/// The runs that form one point of the control charts.
struct RunGroup {
  std::string label;
  std::size_t epoch = 0;
  std::vector<const ScoredRun*> runs;
  std::size_t moment = 0;  ///< index of this label in the time-ordered list of the labels of all fingers
};

/// A run, and the number of maintenance records of its finger before this run.
struct PlacedRun {
  const ScoredRun* run = nullptr;
  std::size_t epoch = 0;
};

/// Working data of a finger for the control charts. The object refers to runs that the caller owns; the runs
/// must outlive it.
struct FingerTrack {
  FingerHealth health;  ///< track_of() sets the points and notes; NumberWatch adds alarms and references
  ScoreBase base;
  std::vector<RunGroup> groups;             ///< one element per point: the runs of this point
  std::map<std::string, PlacedRun> by_run;  ///< the runs; the key is the name of the run
};

/// Groups the runs of a finger into points, and assigns each maintenance record to the first point after it.
/// @param runs  runs of one finger, sorted by time. They must outlive the track.
/// @param notes  records of all fingers.
[[nodiscard]] FingerTrack track_of(const std::string& finger, const std::vector<ScoredRun>& runs,
                                   const std::vector<Note>& notes, const ScoreBase& base, bool by_day);

/// Sets `moment` of every group. Returns the number of distinct moments over all fingers.
std::size_t place_in_time(std::vector<FingerTrack>& tracks);

}  // namespace softgrip::sysid::health
