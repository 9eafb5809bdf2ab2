#pragma once
// Finds the candidate causes of an alarm, whose signs (sysid/diagnosis/causes/) match the alarm best, and the
// steps that confirm one of them.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/rig_health.h"

namespace softgrip::sysid::health {

struct Suspect {
  std::string id;                       ///< id of the cause
  std::string words;                    ///< "the pressure falls while it should be constant"
  std::vector<std::string> next_steps;  ///< checks for the operator, the quicker one first
};

struct Suspicion {
  std::vector<Suspect> suspects;    ///< the best one first; the others are about equally good
  std::vector<std::string> advice;  ///< how to distinguish the candidates
};

/// Returns the candidate causes of the active alarms. The list is empty if there is no alarm, or if no cause
/// has signs that match.
/// @param shared  shared changes of the rig. Those that started no later than the latest alarm also count as
/// signs.
[[nodiscard]] Suspicion suspicion_of(const FingerHealth& health,
                                     const std::vector<SharedChange>& shared = {});

/// Returns the state of the finger and the candidate causes as text for a technician.
[[nodiscard]] std::string health_sentence(const FingerHealth& health, const Suspicion& suspicion);

}  // namespace softgrip::sysid::health
