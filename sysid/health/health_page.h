#pragma once
// Writes the page of a finger: its state, the candidate faults and remedies, and every indicator over time
// with the repairs.

#include <string>
#include <vector>

#include "sysid/health/rig_health.h"
#include "sysid/health/suspicion.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid::health {

/// The sources that a page states.
struct HealthSource {
  std::string baseline;  ///< folder
  ScoreBase base;
  HealthOptions options;
  std::vector<SharedChange> shared{};  ///< with the other fingers
};

[[nodiscard]] sysid::Page health_page(const FingerHealth& health, const Suspicion& suspicion,
                                      const HealthSource& source);

/// Returns the command that confirms a candidate fault without the rig.
[[nodiscard]] std::string settling_command(const std::string& baseline);

}  // namespace softgrip::sysid::health
