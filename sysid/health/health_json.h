#pragma once
// Writes health.json, the current state of all fingers. User programs, `softgrip status`, `softgrip doctor`
// and Prometheus read this file. docs/how-to/watch-a-finger.md lists its keys.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sysid/health/rig_health.h"
#include "sysid/health/suspicion.h"

namespace softgrip::sysid::health {

/// Name of the file in the output folder.
inline constexpr const char* health_file = "health.json";

/// Returns the JSON object of one finger.
[[nodiscard]] nlohmann::ordered_json json_of(const FingerHealth& health, const Suspicion& suspicion);
/// Returns the JSON object of a change that several fingers share.
[[nodiscard]] nlohmann::ordered_json json_of(const SharedChange& shared);

}  // namespace softgrip::sysid::health
