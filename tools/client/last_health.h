#pragma once
// Reads the last result of `softgrip health` from the folder of the recordings.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// Name of the subfolder for the results of softgrip-health.service. It lies in the folder of the recordings.
inline constexpr const char* health_folder = "health";
/// Age above which a result of `softgrip health` is out of date [s].
inline constexpr double health_old_s = 3 * 86400.0;

/// Returns the content of health.json in the folder `recordings`/health with the added member `age_s`.
/// Returns null if the file cannot be read.
/// @param recordings  folder of the recordings, or empty if there is none.
[[nodiscard]] nlohmann::ordered_json last_health(const std::string& recordings);

/// One line about the health of the fingers. The list contains one line per changed finger, or one line for
/// all fingers together, and one line if the result is out of date. It is empty if `health` is null.
struct HealthLine {
  std::string text;
  bool good = true;
  std::string advice;  ///< remedy for the alarm; empty if none is needed
};
[[nodiscard]] std::vector<HealthLine> health_lines(const nlohmann::ordered_json& health);

}  // namespace softgrip::tools
