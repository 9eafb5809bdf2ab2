#pragma once
// What may be behind an alarm: the cause whose signs it shows best, by what the causes' own files say of
// themselves, and what would settle it.

#include <string>
#include <string_view>
#include <vector>

#include "tools/health/finger_health.h"
#include "tools/health/rig_health.h"

namespace softgrip::tools::health {

struct Suspect {
  std::string id;                       ///< of the vocabulary of causes
  std::string words;                    ///< "pressure is lost while it should hold"
  std::vector<std::string> next_steps;  ///< what a person can do, the quicker first
};

struct Suspicion {
  std::vector<Suspect> suspects;    ///< the first explains most; others explain as much
  std::vector<std::string> advice;  ///< what tells them apart
};

/// Of the alarms that stand; empty where there are none, or where no cause shows such signs.
/// @param shared  what the rig shares: where it came before an alarm or with it, it is a sign, too.
[[nodiscard]] Suspicion suspicion_of(const FingerHealth& health,
                                     const std::vector<SharedChange>& shared = {});

/// The finger's state in one sentence that a technician understands.
[[nodiscard]] std::string health_sentence(const FingerHealth& health, const Suspicion& suspicion);

}  // namespace softgrip::tools::health
