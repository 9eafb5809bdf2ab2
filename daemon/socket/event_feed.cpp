#include "daemon/socket/event_feed.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/periodic_schedule.h"
#include "daemon/socket/reply_json.h"
#include "daemon/socket/status_json.h"

namespace softgrip::daemon {

namespace {

using Json = nlohmann::ordered_json;

/// Largest number of events that one subscriber gets per turn, so that the other subscribers do not wait too
/// long.
constexpr std::size_t max_events_per_turn = 50;

}  // namespace

EventFeed::EventFeed(const EventLog& log, Nanoseconds origin, std::string started_at)
    : log_(log), origin_(origin), started_at_(std::move(started_at)) {}

Json EventFeed::subscribe(ClientId client, const ClientRequest& request) {
  const std::uint64_t newest = log_.newest();
  const bool is_earlier_run = !request.started_at.empty() && request.started_at != started_at_;
  const std::uint64_t since = is_earlier_run ? 0 : std::min(request.since.value_or(newest), newest);
  subscriptions_[client] = {request.id, since};
  return {{"since", since}, {"oldest", log_.oldest()}, {"newest", newest}, {"started_at", started_at_}};
}

Json EventFeed::list(const ClientRequest& request, Nanoseconds now) {
  Json list = Json::array();
  for (const EventEntry& event : log_.since(request.since.value_or(0), request.limit)) {
    list.push_back(event_with_time(event, now));
  }
  return {{"events", std::move(list)}, {"newest", log_.newest()}};
}

void EventFeed::send_new_events(Nanoseconds now, const SendLine& send) {
  const std::uint64_t newest = log_.newest();
  for (auto& [client, subscription] : subscriptions_) {
    if (subscription.last == newest) continue;
    for (const EventEntry& event : log_.since(subscription.last, max_events_per_turn)) {
      const Json line{{"id", id_json(subscription.id)}, {"event", event_with_time(event, now)}};
      if (!send(client, line_of(line), true)) break;
      subscription.last = event.id;
    }
  }
}

Json EventFeed::event_with_time(const EventEntry& event, Nanoseconds now) {
  Json json = event_json(event);
  json["at"] = utc_text(wall_origin(now) + nanoseconds(event.time_s), 3);
  return json;
}

/// Returns the wall-clock time at time 0 of the event log. The result changes if the wall clock was set, and
/// for no other reason. Therefore, an event that is sent twice has the same time in both messages.
Nanoseconds EventFeed::wall_origin(Nanoseconds now) {
  constexpr Nanoseconds clock_step = ns_per_s / 2;
  const Nanoseconds origin = wall_time_now() - (now - origin_);
  if (!wall_origin_ || std::abs(origin - *wall_origin_) > clock_step) wall_origin_ = origin;
  return *wall_origin_;
}

}  // namespace softgrip::daemon
