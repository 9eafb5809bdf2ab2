#include "tools/web/metrics/metrics.h"

#include <nlohmann/json.hpp>

#include "base/json.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using enum MetricText::Type;

}  // namespace

void add_health_metrics(const Json& health, MetricText& metrics) {
  if (!health.is_object()) return;
  metrics.family("softgrip_health_timestamp_seconds", gauge,
                 "Time at which softgrip health computed its last result, in seconds since 1970-01-01 UTC.");
  metrics.sample(json_number(health, "made_unix_s"));
  const Json& shared = json_member(health, "shared");
  if (shared.is_array() && !shared.empty()) {
    metrics.family("softgrip_health_shared", gauge,
                   "1 for each indicator that has changed in the same direction at all fingers of the rig.");
    for (const Json& number : shared) {
      if (number.is_string()) metrics.sample({{"number", number.get<std::string>()}}, 1);
    }
  }
  const Json& fingers = json_member(health, "fingers");
  if (!fingers.is_array()) return;
  metrics.family("softgrip_health_state", gauge,
                 "1 for the present health state of the finger, 0 for the other states.");
  for (const Json& finger : fingers) {
    for (const char* state : {"learning", "steady", "alarm"})
      metrics.sample({{"channel", json_text(finger, "finger")}, {"state", state}},
                     json_text(finger, "state") == state ? 1 : 0);
  }
  metrics.family("softgrip_health_suspect", gauge,
                 "1 for every candidate fault of a finger that has changed.");
  for (const Json& finger : fingers) {
    const Json& suspects = json_member(finger, "suspects");
    if (!suspects.is_array()) continue;
    for (const Json& suspect : suspects)
      metrics.sample({{"channel", json_text(finger, "finger")}, {"cause", json_text(suspect, "id")}}, 1);
  }
}

}  // namespace softgrip::web
