#pragma once
// Reads the last result of `softgrip health` from the folder of the recordings.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// The subfolder for the results in the folder of the recordings. softgrip-health.service writes there.
inline constexpr const char* health_folder = "health";
/// A result of this age is out of date [s].
inline constexpr double health_old_s = 3 * 86400.0;

/// Returns health.json of this folder with the added member `age_s`. Returns null if it cannot be read.
/// @param recordings  folder of the recordings, or empty if there is none.
[[nodiscard]] nlohmann::ordered_json last_health(const std::string& recordings);

/// One line per finger that has changed, or one line for all fingers, and one line if the result is out of
/// date. The list is empty if `health` is null.
struct HealthLine {
  std::string text;
  bool good = true;
  std::string advice;  ///< remedy; empty if none is needed
};
[[nodiscard]] std::vector<HealthLine> health_lines(const nlohmann::ordered_json& health);

}  // namespace softgrip::tools
