#pragma once
// Writes the report page of a finger: its state, the candidate faults and remedies, and every indicator over
// time with the repairs.
// Finds the candidate causes of an alarm, and the checks that confirm one of them. A candidate is a cause
// whose signs (sysid/diagnosis/causes/) match the alarm best.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/rig_health.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid::health {

struct Suspect {
  std::string id;  ///< id of the cause
  /// The cause as text: "the pressure falls while it should be constant".
  std::string words;
  std::vector<std::string> next_steps;  ///< checks for the operator; the quickest check comes first
};

struct Suspicion {
  /// Candidate causes; the best one comes first, and all of them have nearly equal scores.
  std::vector<Suspect> suspects;
  std::vector<std::string> advice;  ///< checks that distinguish the candidates from each other
};

/// Returns the candidate causes of the active alarms. The list is empty if there is no alarm, or if no cause
/// has matching signs.
/// @param shared  shared changes of the rig. A shared change that started no later than the latest alarm also
/// counts as a sign.
[[nodiscard]] Suspicion suspicion_of(const FingerHealth& health,
                                     const std::vector<SharedChange>& shared = {});

/// Returns the state of the finger and the candidate causes as text for a technician.
[[nodiscard]] std::string health_sentence(const FingerHealth& health, const Suspicion& suspicion);

/// Data that the page of a finger shows in addition to the health of this finger.
struct HealthSource {
  std::string baseline;  ///< path of the folder of the baseline
  ScoreBase base;
  HealthOptions options;
  std::vector<SharedChange> shared{};  ///< changes that several fingers of the rig share
};

[[nodiscard]] sysid::Page health_page(const FingerHealth& health, const Suspicion& suspicion,
                                      const HealthSource& source);

/// Returns the command line that diagnoses a new recording of the commissioning experiment, to confirm a
/// candidate fault.
[[nodiscard]] std::string settling_command(const std::string& baseline);

}  // namespace softgrip::sysid::health
