#include "sysid/health/finger_health.h"

#include <algorithm>

namespace softgrip::sysid::health {
const char* name_of(FingerState state) {
  if (state == FingerState::alarm) return "alarm";
  return state == FingerState::steady ? "steady" : "learning";
}

std::vector<HealthAlarm> FingerHealth::standing() const {
  std::vector<HealthAlarm> now;
  for (const HealthAlarm& alarm : alarms) {
    if (alarm.epoch == epoch()) now.push_back(alarm);
  }
  return now;
}

std::optional<double> FingerHealth::latest(sysid::HealthNumber number) const {
  const auto i = static_cast<std::size_t>(number);
  const std::string recipe = references[i] ? references[i]->recipe : std::string();
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    const ChartValues& values = point->values[i];
    if (values.empty()) continue;
    const auto same = values.find(recipe);
    return same != values.end() ? same->second.value : values.begin()->second.value;
  }
  return std::nullopt;
}

std::vector<sysid::HealthNumber> shared_changes(const std::vector<const FingerHealth*>& fingers) {
  std::vector<sysid::HealthNumber> shared;
  if (fingers.size() < 2) return shared;
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    std::size_t up = 0, down = 0;
    for (const FingerHealth* finger : fingers) {
      for (const HealthAlarm& alarm : finger->standing()) {
        if (static_cast<std::size_t>(alarm.number) == i) ++(alarm.change > 0 ? up : down);
      }
    }
    if (std::max(up, down) == fingers.size()) shared.push_back(static_cast<sysid::HealthNumber>(i));
  }
  return shared;
}

}  // namespace softgrip::sysid::health
