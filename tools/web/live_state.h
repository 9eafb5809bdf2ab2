#pragma once
// Stores the latest data of the daemon. All responses to browsers and collectors are made from these data. A
// connection to the daemon provides the data. One connection serves any number of browsers.

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/time.h"
#include "tools/client/daemon_client.h"

namespace softgrip::web {

class LiveState {
 public:
  static constexpr double trend_s = 60;
  static constexpr std::size_t events_kept = 200;

  /// The functions set_...() and add_event() store new data of the daemon, and add a message for the open
  /// pages.
  void set_status(nlohmann::ordered_json status);
  void add_event(nlohmann::ordered_json event);
  void set_statistics(nlohmann::ordered_json statistics);
  void set_sequences(nlohmann::ordered_json sequences);
  /// Stores the last result of `softgrip health`, which is read from the disk.
  void set_health(nlohmann::ordered_json health) { health_ = std::move(health); }
  /// Discards the status, the statistics and the trend, because they are unknown. Keeps the past events. Must
  /// be called when the connection to the daemon is lost.
  void clear_live_data();

  /// Returns the last status; null if no daemon is connected.
  [[nodiscard]] const nlohmann::ordered_json& status() const noexcept { return status_; }
  [[nodiscard]] const nlohmann::ordered_json& statistics() const noexcept { return statistics_; }
  [[nodiscard]] const nlohmann::ordered_json& sequences() const noexcept { return sequences_; }
  /// Returns the last health result; null if there is none.
  [[nodiscard]] const nlohmann::ordered_json& health() const noexcept { return health_; }

  /// Returns the complete state as a message. It is the first message of a stream of server-sent events.
  [[nodiscard]] std::string snapshot_message() const;
  /// Returns one message per change since the last call; "" if there was no change.
  [[nodiscard]] std::string take_messages();

 private:
  void append_to_trend();

  nlohmann::ordered_json status_;
  nlohmann::ordered_json statistics_;
  nlohmann::ordered_json sequences_;
  nlohmann::ordered_json health_;
  std::deque<nlohmann::ordered_json> events_;
  // Samples of the trend, one per status: [time_s, [command, pressure, displacement, reference], ...]. Each
  // sample has one inner list per finger.
  std::deque<nlohmann::ordered_json> trend_;
  std::string messages_;
};

/// Formats one message of a stream of server-sent events.
[[nodiscard]] std::string message_of(std::string_view kind, const nlohmann::ordered_json& data);

class DaemonWatch {
 public:
  /// Creates the object and does not connect. `socket` is the path of the daemon's read-only socket. `state`
  /// must outlive this object.
  DaemonWatch(const std::string& socket, LiveState& state) : state_(state), daemon_(socket) {}

  /// Reads the daemon's lines, sends the requests that are due, and reconnects after a loss. Must be called
  /// when the descriptor is readable, and several times per second.
  void update(Nanoseconds now);
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return daemon_.descriptor(); }

 private:
  void send_initial_requests(Nanoseconds now);
  void process_line(nlohmann::ordered_json line, Nanoseconds now);
  void process_result(std::uint64_t id, nlohmann::ordered_json result);
  void send_due_requests(Nanoseconds now);

  LiveState& state_;
  tools::DaemonLink daemon_;
  Nanoseconds last_status_at_ = 0;  // time of the last state that the daemon has sent
  Nanoseconds statistics_due_ = 0;
  Nanoseconds sequences_due_ = 0;
  std::string started_at_;  // start time of the daemon process that sent the last received events
  std::uint64_t last_event_ = 0;
};

}  // namespace softgrip::web
