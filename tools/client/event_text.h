#pragma once
// Events of the daemon as lines for people.

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// "   12.340 s  warning  left: The grip's result is NO PART." of an event as the socket API tells it; of one
/// that carries the time of day, "2026-11-21 09:32:05.123  warning  ..." in local time.
[[nodiscard]] std::string line_of_event(const nlohmann::ordered_json& event);

}  // namespace softgrip::tools
