#include "tools/client/event_query.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "base/clock.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t page_size = 1000;

std::size_t rank_of(std::string_view severity) {
  return severity == "error" ? 2U : severity == "warning" ? 1U : 0U;
}

std::optional<Nanoseconds> duration_of(std::string_view number, std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, Nanoseconds>, 5> units{
      {{"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}, {"d", 86400}}};
  const auto* const found =
      std::find_if(units.begin(), units.end(), [&](const auto& known) { return known.first == unit; });
  if (found == units.end() || number.size() > 6) return std::nullopt;
  const Nanoseconds count = std::strtol(std::string(number).c_str(), nullptr, 10);
  if (count > std::numeric_limits<Nanoseconds>::max() / ns_per_s / found->second) return std::nullopt;
  return count * found->second * ns_per_s;
}

/// Parses a local time of day or date. Units that are missing in the text are taken from `now` if they are
/// larger than the units in the text, for example the date. Missing smaller units are 0.
std::optional<Nanoseconds> parse_local_time(const std::string& text, Nanoseconds now) {
  const time_t now_s = now / ns_per_s;
  for (const char* format : {"%Y-%m-%d %H:%M:%S", "%Y-%m-%d %H:%M", "%Y-%m-%d", "%H:%M:%S", "%H:%M"}) {
    tm parts{};
    if (::localtime_r(&now_s, &parts) == nullptr) return std::nullopt;
    parts.tm_hour = parts.tm_min = parts.tm_sec = 0;
    parts.tm_isdst = -1;
    const char* const end = ::strptime(text.c_str(), format, &parts);
    if (end == nullptr || *end != '\0') continue;
    const int day = parts.tm_mday;
    const time_t time_s = std::mktime(&parts);
    // mktime() changes a day that does not exist, such as 31 February, to another day.
    if (parts.tm_mday == day) return static_cast<Nanoseconds>(time_s) * ns_per_s;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Since> parse_since(const std::string& text, Nanoseconds now) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  if (!text.empty() && digits == text.size() && digits < 17) {
    return Since{std::strtoull(text.c_str(), nullptr, 10), {}};
  }
  std::optional<Nanoseconds> time;
  if (digits > 0) {
    const auto before =
        duration_of(std::string_view(text).substr(0, digits), std::string_view(text).substr(digits));
    if (before) time = now - *before;
  }
  if (!time) time = parse_local_time(text, now);
  if (!time) return std::nullopt;
  return Since{0, utc_text(*time, 3)};
}

bool matches(const EventQuery& query, const Json& event) {
  return event.value("id", std::uint64_t{0}) > query.since.id && event.value("at", "") >= query.since.at &&
         rank_of(event.value("severity", "")) >= rank_of(query.severity);
}

std::uint64_t missing_before(const Json& next, std::uint64_t last) {
  const std::uint64_t id = next.value("id", last);
  return last == 0 || id <= last ? 0 : id - last - 1;
}

tl::expected<FoundEvents, ClientFailure> query_events(DaemonClient& client, const EventQuery& query) {
  FoundEvents found;
  found.newest = query.since.id;
  for (;;) {
    const auto result = client.call({{"command", "events"}, {"since", found.newest}, {"limit", page_size}});
    if (!result) return tl::unexpected{result.error()};
    const Json events = result->value("events", Json::array());
    for (const Json& event : events) {
      found.missing += missing_before(event, found.newest);
      found.newest = std::max(found.newest, event.value("id", found.newest));
      if (matches(query, event)) found.events.push_back(event);
    }
    if (events.size() < page_size) break;
  }
  if (found.events.size() > query.lines)
    found.events.erase(found.events.begin(), found.events.end() - static_cast<long>(query.lines));
  return found;
}

}  // namespace softgrip::tools
