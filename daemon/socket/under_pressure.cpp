#include "daemon/socket/under_pressure.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace softgrip::daemon {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json under_pressure_json(const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot) {
  if (snapshot.under_pressure == 0) return nullptr;
  Json pressed = Json::array();
  std::string list;
  for (std::size_t i = 0; i < snapshot.channel_count; ++i) {
    const double command_kpa = snapshot.channels[i].command_kpa;
    if ((snapshot.under_pressure & (1U << i)) == 0) continue;
    pressed.push_back({{"name", channels[i].name}, {"command_kpa", command_kpa}});
    list += fmt::format("{}{} {:.1f} kPa", list.empty() ? "" : ", ", channels[i].name, command_kpa);
  }
  const bool idle = snapshot.state == control::State::idle;
  const char* const command = idle ? "softgrip release" : "softgrip vent";
  return {{"channels", std::move(pressed)},
          {"command", command},
          {"text",
           fmt::format("Fingers are pressurised: {}. `{}` vents them; a held part drops.", list, command)}};
}

}  // namespace softgrip::daemon
