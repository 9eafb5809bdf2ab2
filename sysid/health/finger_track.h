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

/// The runs of one point.
struct RunGroup {
  std::string label;
  std::size_t epoch = 0;
  std::vector<const ScoredRun*> runs;
  std::size_t moment = 0;  ///< index of the label among the labels of all fingers, in order of time
};

/// A run, and the number of earlier maintenance records of its finger.
struct PlacedRun {
  const ScoredRun* run = nullptr;
  std::size_t epoch = 0;
};

/// Working data of a finger for the charts. The runs are stored elsewhere and must outlive it.
struct FingerTrack {
  FingerHealth health;  ///< points and notes; NumberWatch adds the rest
  ScoreBase base;
  std::vector<RunGroup> groups;             ///< one per point
  std::map<std::string, PlacedRun> by_run;  ///< by the run's name
};

/// Groups the runs of a finger into points and assigns the maintenance records.
/// @param runs  of one finger, sorted by time. They must outlive the track. @param notes  of all fingers.
[[nodiscard]] FingerTrack track_of(const std::string& finger, const std::vector<ScoredRun>& runs,
                                   const std::vector<Note>& notes, const ScoreBase& base, bool by_day);

/// Sets `moment` of every group. Returns the number of moments.
std::size_t place_in_time(std::vector<FingerTrack>& tracks);

}  // namespace softgrip::sysid::health
