#pragma once
// A finger's runs on the way to its health: in groups that become points, each with its place in the rig's
// time.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

/// Runs in one point.
struct RunGroup {
  std::string label;
  std::size_t epoch = 0;
  std::vector<const ScoredRun*> runs;
  std::size_t moment = 0;  ///< index of the label among all of the rig, in the order of time
};

/// A run, and the number of earlier repairs of its finger.
struct PlacedRun {
  const ScoredRun* run = nullptr;
  std::size_t epoch = 0;
};

/// Working data of a finger for the charts. The runs are stored elsewhere and must outlive it.
struct FingerTrack {
  FingerHealth health;  ///< with its points and notes; the judges add the rest
  ScoreBase base;
  std::vector<RunGroup> groups;             ///< as many as points
  std::map<std::string, PlacedRun> by_run;  ///< by the run's name
};

/// @param runs  of one finger, sorted by time; they outlive the track. @param notes  of all fingers.
[[nodiscard]] FingerTrack track_of(const std::string& finger, const std::vector<ScoredRun>& runs,
                                   const std::vector<Note>& notes, const ScoreBase& base, bool by_day);

/// Gives every group its moment. Returns how many there are.
std::size_t place_in_time(std::vector<FingerTrack>& tracks);

}  // namespace softgrip::sysid::health
