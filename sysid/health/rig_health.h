#pragma once
// Judges the health of the fingers of a rig and compares each finger with the others.
//
// Influences that last for days, above all the weather, change all fingers of a rig in the same way. Every
// indicator of a finger therefore has two control charts. One shows the finger's own values. The other shows
// the difference between the finger and its peer fingers in the same runs. Mortell and Runger describe such
// charts for processes with several streams (Journal of Quality Technology 27, 1995). The charts distinguish
// three cases:
//
// - The difference has changed. The change is attributed to a finger if its own values have changed more than
//   the values of its peers, with a likelihood ratio of at least 20 to 1. Otherwise the change is reported as
//   unclear, without an alarm. With two fingers, the two differences have equal magnitudes and opposite
//   signs, so both charts of the difference alarm together.
// - The finger's own values have changed, and the values of its peers have changed in the same direction by
//   at least half as much. This is a shared change. It is reported without an alarm, and the changed values
//   become the new reference.
// - The finger's own values have changed, and the values of its peers have not. This is an alarm, as for a
//   finger without peers.
//
// A finger in alarm is not compared with other fingers. After a repair of a finger, its comparison with the
// others starts without a reference.

#include <string>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {

struct FingerRuns {
  std::string finger;
  std::vector<ScoredRun> runs;
  ScoreBase base;  ///< baseline of the finger; determines the output unit and which differences are
                   ///< negligible
};

/// A change that several fingers share.
struct SharedChange {
  sysid::HealthNumber number = sysid::HealthNumber::gain;
  double change = 0;           ///< change of the finger in which the change was detected first, in the unit
                               ///< of the indicator
  std::string since, noticed;  ///< labels of the first changed point and of the point of detection
  std::vector<std::string> fingers;
  /// True: the temperature was recorded, and its known effect was removed from the change.
  bool temperature_recorded = false;
  /// True: the change is active. False: a later repair or a later shared change ended the change, or the
  /// alarm of a finger explains the change.
  bool stands = true;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of `change`
};

struct RigHealth {
  std::vector<FingerHealth> fingers;  ///< in the order of the argument `fingers` of judge_rig()
  std::vector<SharedChange> shared;   ///< sorted by indicator, then by the time of detection
};

/// Judges all fingers of a rig. Runs with the same name belong to the same grip. Fingers that have runs of
/// the same grips are peer fingers.
[[nodiscard]] RigHealth judge_rig(std::vector<FingerRuns> fingers, const std::vector<Note>& notes,
                                  const HealthOptions& options);

/// Judges a finger that has no peer fingers.
[[nodiscard]] FingerHealth judge_finger(const std::string& finger, std::vector<ScoredRun> runs,
                                        const std::vector<Note>& notes, const ScoreBase& base,
                                        const HealthOptions& options);

/// Returns a change as text: "gain (at full pressure) -0.62 mm".
[[nodiscard]] std::string change_text(sysid::HealthNumber number, double change, model::OutputUnit unit);

/// Returns the sentence about an unattributed change (FingerHealth::unclear): "Since 2026-03-20, the
/// difference between left and right has changed: ..."
[[nodiscard]] std::string unclear_sentence(const FingerHealth& health, const HealthAlarm& unclear);

/// Returns the sentence about a shared change, and the checks that find its cause: "Since 2026-03-20, all
/// fingers of the rig show the same change: ..."
[[nodiscard]] std::string shared_sentence(const SharedChange& shared);

}  // namespace softgrip::sysid::health
