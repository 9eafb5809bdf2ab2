#pragma once
// Selects events of the daemon by id, time and severity, up to a largest number of events.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/time.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// The start of a selection of events: the selected events are newer than a given event id, or not older than
/// a given time.
struct Since {
  std::uint64_t id = 0;  ///< only events with a larger id than `id` are selected
  std::string at;        ///< only events at or after this UTC time are selected; format as in the socket API;
                         ///< empty: all times
};

/// Parses the start of a selection. The text is the id of an event ("1234"), a duration before `now` ("90s",
/// "10min", "2h", "1d"; `now` in nanoseconds since 1970), or a local time ("10:15", "10:15:30", "2026-11-21",
/// "2026-11-21 10:15"). Returns nullopt for any other text.
[[nodiscard]] std::optional<Since> parse_since(const std::string& text, Nanoseconds now);

struct EventQuery {
  Since since;
  std::string severity = "information";  ///< lowest severity of a selected event: information, warning or
                                         ///< error
  std::size_t lines = 100;  ///< largest number of selected events; the newest events are selected
};

/// Returns true if the event has the required id, time and severity. This function does not use `lines`.
[[nodiscard]] bool matches(const EventQuery& query, const nlohmann::ordered_json& event);

/// Returns the number of events that are missing between the event with the id `last` and the next event. The
/// ids of the daemon's events are consecutive. If `last` is 0, there is no earlier event, and the result is
/// 0.
[[nodiscard]] std::uint64_t missing_before(const nlohmann::ordered_json& next, std::uint64_t last);

struct FoundEvents {
  std::vector<nlohmann::ordered_json> events;  ///< selected events, the newest event last
  std::uint64_t newest = 0;                    ///< id of the newest event of the daemon
  std::uint64_t missing = 0;  ///< number of events after `since.id` that the daemon no longer stores
};

/// Returns the events that a query selects.
[[nodiscard]] tl::expected<FoundEvents, ClientFailure> query_events(DaemonClient& client,
                                                                    const EventQuery& query);

}  // namespace softgrip::tools
