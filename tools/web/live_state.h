#pragma once
// Stores the latest data of the daemon. All responses to browsers and collectors are made from these data.
// Uses no sockets.

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

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

}  // namespace softgrip::web
