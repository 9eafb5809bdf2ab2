#pragma once
// Writes the report page of a finger: its state, the candidate faults and remedies, and every indicator over
// time with the repairs.

#include <string>
#include <vector>

#include "sysid/health/rig_health.h"
#include "sysid/health/suspicion.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid::health {

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
