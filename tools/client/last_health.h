#pragma once
// Reads the last result of `softgrip health` from the folder of the recordings.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// Name of the subfolder for the results of softgrip-health.service, in the folder of the recordings.
inline constexpr const char* health_folder = "health";
/// Age above which a result of `softgrip health` is out of date [s].
inline constexpr double health_old_s = 3 * 86400.0;

/// Returns the content of health.json from the subfolder `health`, with the added member `age_s`. Returns
/// null if the file cannot be read.
/// @param recordings  folder of the recordings; empty if there is none
[[nodiscard]] nlohmann::ordered_json last_health(const std::string& recordings);

/// One line of text about the health of the fingers. The complete list contains one line per changed finger,
/// or one line for all fingers together. If the result is out of date, one more line states this. The list is
/// empty if `health` is null.
struct HealthLine {
  std::string text;
  bool good = true;
  std::string advice;  ///< remedy for the alarm; empty if no remedy is needed
};
[[nodiscard]] std::vector<HealthLine> health_lines(const nlohmann::ordered_json& health);

}  // namespace softgrip::tools
