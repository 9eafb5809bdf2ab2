#pragma once
// The page of a finger: how it is, what is suspected and what to do, every number over time with what was
// mended in between.

#include <string>
#include <vector>

#include "sysid/pages/page.h"
#include "tools/health/rig_health.h"
#include "tools/health/suspicion.h"

namespace softgrip::tools::health {

/// What a page says of where it comes from.
struct HealthSource {
  std::string baseline;  ///< folder
  ScoreBase base;
  HealthOptions options;
  std::vector<SharedChange> shared{};  ///< with the other fingers
};

[[nodiscard]] sysid::Page health_page(const FingerHealth& health, const Suspicion& suspicion,
                                      const HealthSource& source);

/// What settles a suspicion at the desk: a command.
[[nodiscard]] std::string settling_command(const std::string& baseline);

}  // namespace softgrip::tools::health
