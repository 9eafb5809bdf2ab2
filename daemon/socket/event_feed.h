#pragma once
// Sends events of the daemon to the clients of the socket API that have subscribed to them.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/time.h"
#include "daemon/recording/event_log.h"
#include "daemon/socket/client_request.h"

namespace softgrip::daemon {

/// Id of a connection. Each connection has an id that no other connection ever gets.
using ClientId = std::uint64_t;

/// Sends a line with its line break to a client. If `skippable` is true and the client has not read the
/// earlier lines yet, does not send the line and returns false.
using SendLine = std::function<bool(ClientId client, std::string_view line, bool skippable)>;

/// The subscriptions of all clients. All functions must be called from one thread.
class EventFeed {
 public:
  /// `origin` is the time 0 of the event log [ns]. `started_at` identifies this run of the daemon. The log
  /// must exist longer than this object.
  EventFeed(const EventLog& log, Nanoseconds origin, std::string started_at);

  /// Subscribes a client to events and returns the result of the request. If the `started_at` of the request
  /// belongs to an earlier run of the daemon, the client's event ids are not valid. In this case, the client
  /// gets all stored events.
  nlohmann::ordered_json subscribe(ClientId client, const ClientRequest& request);
  void unsubscribe(ClientId client) { subscriptions_.erase(client); }
  /// Returns true if the client has a subscription.
  [[nodiscard]] bool has(ClientId client) const { return subscriptions_.contains(client); }
  /// Returns the stored events that match the request.
  [[nodiscard]] nlohmann::ordered_json list(const ClientRequest& request, Nanoseconds now);
  /// Sends new events to the subscribers. If a client does not read, its events are sent when it reads again,
  /// as long as the log stores them. No thread waits for such a client.
  void send_new_events(Nanoseconds now, const SendLine& send);

  [[nodiscard]] const EventLog& log() const noexcept { return log_; }

 private:
  struct Subscription {
    std::optional<std::uint64_t> id;
    std::uint64_t last = 0;  ///< id of the newest event that was sent to the subscriber
  };

  [[nodiscard]] nlohmann::ordered_json event_with_time(const EventEntry& event, Nanoseconds now);
  [[nodiscard]] Nanoseconds wall_origin(Nanoseconds now);

  const EventLog& log_;
  Nanoseconds origin_;
  std::string started_at_;
  std::map<ClientId, Subscription> subscriptions_;
  std::optional<Nanoseconds> wall_origin_;  ///< wall-clock time at the time origin_
};

}  // namespace softgrip::daemon
