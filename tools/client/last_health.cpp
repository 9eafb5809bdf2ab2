#include "tools/client/daemon_text.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/files.h"
#include "base/json.h"
#include "base/numbers.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t largest_result = std::size_t{4} * 1024 * 1024;
constexpr std::size_t longest_sentence = 4000;
constexpr double hour_s = 3600, day_s = 86400;

std::string age_text(double age_s) {
  return age_s < 2 * day_s ? fixed(age_s / hour_s, 0) + " h ago" : fixed(age_s / day_s, 0) + " days ago";
}

/// Returns the first recommended step for the first candidate fault of a finger; "" if there is none.
std::string first_step(const Json& finger) {
  const auto suspects = finger.find("suspects");
  if (suspects == finger.end() || !suspects->is_array() || suspects->empty()) return {};
  const Json& suspect = suspects->front();
  if (!suspect.is_object() || !suspect.contains("next_steps")) return {};
  const Json& steps = suspect["next_steps"];
  return steps.is_array() && !steps.empty() && steps.front().is_string() ? steps.front().get<std::string>()
                                                                         : std::string();
}

}  // namespace

Json last_health(const std::string& recordings) {
  if (recordings.empty()) return nullptr;
  const auto path = std::filesystem::path(recordings) / health_folder / "health.json";
  const auto text = read_file(path.string(), largest_result);
  if (!text) return nullptr;
  Json health = parse_json<Json>(*text);
  if (!health.is_object() || !health.contains("made_unix_s") || !health["made_unix_s"].is_number() ||
      !health.contains("fingers") || !health["fingers"].is_array())
    return nullptr;
  health["age_s"] = static_cast<double>(wall_time_now()) * 1e-9 - health["made_unix_s"].get<double>();
  return health;
}

std::vector<HealthLine> health_lines(const Json& health) {
  std::vector<HealthLine> lines;
  if (!health.is_object()) return lines;
  const double age_s = health["age_s"].get<double>();
  std::size_t fingers = 0;
  for (const Json& finger : health["fingers"]) {
    if (!finger.is_object()) continue;
    ++fingers;
    if (text_at(finger, "state") == "alarm")
      lines.push_back({text_at(finger, "sentence", longest_sentence), false, first_step(finger)});
  }
  const bool changed = !lines.empty();
  const auto warnings = health.find("warnings");
  if (warnings != health.end() && warnings->is_array()) {
    for (const Json& warning : *warnings) {
      if (warning.is_string())
        lines.push_back({warning.get<std::string>().substr(0, longest_sentence), false, ""});
    }
  }
  const std::string when = "checked " + age_text(age_s);
  if (!changed)
    lines.push_back({"no change detected at " + std::to_string(fingers) + " fingers, " + when, true, ""});
  if (age_s > health_old_s)
    lines.push_back({"the fingers were last " + when, false, "systemctl status softgrip-health.timer"});
  return lines;
}

}  // namespace softgrip::tools
