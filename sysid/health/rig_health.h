#pragma once
// The health of the fingers of a rig, each compared with the others.
//
// Influences that last for days, above all the weather, move all fingers of a rig alike. Every number
// therefore has two charts: of the finger's own values, and of their difference from the peer fingers on the
// same runs, as for a process with several streams (Mortell and Runger, Journal of Quality Technology 27,
// 1995). The charts distinguish three cases:
//
// - The difference has changed. The fingers' own numbers attribute the change to a finger: the movement of
//   each about the time of the change is compared with their usual common drift (likelihood ratio 20 to 1).
//   Until the attribution is sure, the change is reported as unclear, without an alarm. With two fingers, the
//   two differences are one, and a false alarm of it is a false alarm of one of them.
// - The own number has changed, and the peers' numbers with it, in the same direction by half as much or
// more:
//   a change that the rig shares. It is reported as such, and becomes the reference of the own number.
// - The own number has changed, and the peers' numbers have not: an alarm, as for a finger without peers.
//
// A finger in alarm is no reference for others. A repair of a finger restarts the differences from it.

#include <string>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

struct FingerRuns {
  std::string finger;
  std::vector<ScoredRun> runs;
  ScoreBase base;  ///< gives the differences that are negligible
};

/// A change that several fingers share.
struct SharedChange {
  sysid::HealthNumber number = sysid::HealthNumber::gain;
  double change = 0;           ///< of the finger that showed it first, in the number's unit
  std::string since, noticed;  ///< labels of points
  std::vector<std::string> fingers;
  bool temperature_recorded = false;  ///< and allowed for, as far as it is known what it does
  /// False: a later repair or a later shared change ended it, or the alarm of a finger explains it.
  bool stands = true;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< of `change`
};

struct RigHealth {
  std::vector<FingerHealth> fingers;  ///< in the order given
  std::vector<SharedChange> shared;   ///< by number, and in the order in which they were noticed
};

/// Judges all fingers of a rig. Runs of the same name belong to the same grip; fingers with common runs are
/// peer fingers.
[[nodiscard]] RigHealth judge_rig(std::vector<FingerRuns> fingers, const std::vector<Note>& notes,
                                  const HealthOptions& options);

/// Judges a finger without peer fingers.
[[nodiscard]] FingerHealth judge_finger(const std::string& finger, std::vector<ScoredRun> runs,
                                        const std::vector<Note>& notes, const ScoreBase& base,
                                        const HealthOptions& options);

/// "gain (at full pressure) -0.62 mm"
[[nodiscard]] std::string change_text(sysid::HealthNumber number, double change, model::OutputUnit unit);

/// "Since 2026-03-20 the gain of left is another beside right's: ...", of FingerHealth::unclear.
[[nodiscard]] std::string unclear_sentence(const FingerHealth& health, const HealthAlarm& unclear);

/// "Since 2026-03-20 left, right have changed alike: gain -0.3 mm. ...": and what to look at.
[[nodiscard]] std::string shared_sentence(const SharedChange& shared);

}  // namespace softgrip::sysid::health
