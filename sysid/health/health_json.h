#pragma once
// Writes health.json, the last state of all fingers, for programs of users, `softgrip status`, `softgrip
// doctor` and Prometheus. docs/how-to/watch-a-finger.md lists the keys.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sysid/health/rig_health.h"
#include "sysid/health/suspicion.h"

namespace softgrip::sysid::health {

/// File name in the output folder.
inline constexpr const char* health_file = "health.json";

/// Returns the JSON of one finger.
[[nodiscard]] nlohmann::ordered_json json_of(const FingerHealth& health, const Suspicion& suspicion);
/// Returns the JSON of a change that all fingers share.
[[nodiscard]] nlohmann::ordered_json json_of(const SharedChange& shared);

}  // namespace softgrip::sysid::health
