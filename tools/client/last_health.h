#pragma once
// What `softgrip health` found last, as it lies beside the recordings.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// Folder of the results within the folder of the recordings; softgrip-health.service writes there.
inline constexpr const char* health_folder = "health";
/// Older than this, nobody looks at the fingers any more [s].
inline constexpr double health_old_s = 3 * 86400.0;

/// health.json of that folder, with `age_s` added; null where there is none that can be read.
/// @param recordings  empty: there are none.
[[nodiscard]] nlohmann::ordered_json last_health(const std::string& recordings);

/// One line per finger that is another, or one for all; and one if it is long ago. None of null.
struct HealthLine {
  std::string text;
  bool good = true;
  std::string advice;  ///< what to do; empty where nothing is to be done
};
[[nodiscard]] std::vector<HealthLine> health_lines(const nlohmann::ordered_json& health);

}  // namespace softgrip::tools
