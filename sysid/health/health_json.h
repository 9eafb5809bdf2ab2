#pragma once
// health.json: the last state of all fingers, for people's programs, `softgrip status`, `doctor` and
// Prometheus. docs/how-to/watch-a-finger.md lists the keys.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sysid/health/rig_health.h"
#include "sysid/health/suspicion.h"

namespace softgrip::sysid::health {

/// Its name in the folder for results.
inline constexpr const char* health_file = "health.json";

/// One finger's part.
[[nodiscard]] nlohmann::ordered_json json_of(const FingerHealth& health, const Suspicion& suspicion);
/// Returns the JSON of a change that all fingers share.
[[nodiscard]] nlohmann::ordered_json json_of(const SharedChange& shared);

}  // namespace softgrip::sysid::health
