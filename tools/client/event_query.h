#pragma once
// Which of the daemon's events somebody wants to see.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/time.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// Since when: behind the event with a number, or from a time of day on.
struct Since {
  std::uint64_t id = 0;  ///< only events with a larger one
  std::string at;        ///< only events at or after this time, in UTC as the socket API tells it; empty: all
};

/// "1234" is an event's number; "90s", "10min", "2h", "1d" so long before `now` (nanoseconds since 1970);
/// "10:15", "10:15:30", "2026-11-21", "2026-11-21 10:15" a local time. Nothing for anything else.
[[nodiscard]] std::optional<Since> parse_since(const std::string& text, Nanoseconds now);

struct EventQuery {
  Since since;
  std::string severity = "information";  ///< at least this: information, warning, error
  std::size_t lines = 100;               ///< the newest so many
};

/// Whether an event is among them, but for their number.
[[nodiscard]] bool wanted(const EventQuery& query, const nlohmann::ordered_json& event);

/// The events of a query, newest last. `newest` becomes the number of the newest one that was looked at.
[[nodiscard]] tl::expected<std::vector<nlohmann::ordered_json>, ClientFailure> events_of(
    DaemonClient& client, const EventQuery& query, std::uint64_t& newest);

}  // namespace softgrip::tools
