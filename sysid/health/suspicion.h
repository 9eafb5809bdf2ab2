#pragma once
// Candidate causes of an alarm: the causes whose signs, as their own files state them, match it best, and the
// steps that would confirm one of them.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/health/finger_health.h"
#include "sysid/health/rig_health.h"

namespace softgrip::sysid::health {

struct Suspect {
  std::string id;                       ///< of the vocabulary of causes
  std::string words;                    ///< "the pressure falls while it should be constant"
  std::vector<std::string> next_steps;  ///< what a person can do, the quicker first
};

struct Suspicion {
  std::vector<Suspect> suspects;    ///< the first explains most; others explain as much
  std::vector<std::string> advice;  ///< how to distinguish them
};

/// Returns the candidate causes of the open alarms. The list is empty if there are none, or if no cause has
/// these signs.
/// @param shared  changes that the rig shares. One that came before an alarm or with it is a sign, too.
[[nodiscard]] Suspicion suspicion_of(const FingerHealth& health,
                                     const std::vector<SharedChange>& shared = {});

/// The finger's state in one sentence that a technician understands.
[[nodiscard]] std::string health_sentence(const FingerHealth& health, const Suspicion& suspicion);

}  // namespace softgrip::sysid::health
