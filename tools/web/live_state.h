#pragma once
// The latest data of the daemon. All responses to browsers and collectors come from here. No sockets.

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

  /// Each of these functions stores new data of the daemon and adds a message for the open pages.
  void take_status(nlohmann::ordered_json status);
  void take_event(nlohmann::ordered_json event);
  void take_statistics(nlohmann::ordered_json statistics);
  void take_sequences(nlohmann::ordered_json sequences);
  /// Stores the last result of `softgrip health`. The daemon does not know it.
  void take_health(nlohmann::ordered_json health) { health_ = std::move(health); }
  /// Call it when the connection to the daemon is lost: only its past events remain known.
  void lose();

  /// The last status, or null if the daemon does not respond.
  [[nodiscard]] const nlohmann::ordered_json& status() const noexcept { return status_; }
  [[nodiscard]] const nlohmann::ordered_json& statistics() const noexcept { return statistics_; }
  [[nodiscard]] const nlohmann::ordered_json& sequences() const noexcept { return sequences_; }
  /// The last health result, or null if there is none.
  [[nodiscard]] const nlohmann::ordered_json& health() const noexcept { return health_; }

  /// Returns the complete state as the first message of a stream of server-sent events.
  [[nodiscard]] std::string greeting() const;
  /// Returns the changes since the last call as further messages, or "" if nothing has changed.
  [[nodiscard]] std::string take_news();

 private:
  void note_trend();

  nlohmann::ordered_json status_;
  nlohmann::ordered_json statistics_;
  nlohmann::ordered_json sequences_;
  nlohmann::ordered_json health_;
  std::deque<nlohmann::ordered_json> events_;
  std::deque<nlohmann::ordered_json> trend_;  // [time_s, [command, pressure, displacement, reference], ...]
  std::string news_;
};

/// Formats one message of a stream of server-sent events.
[[nodiscard]] std::string message_of(std::string_view kind, const nlohmann::ordered_json& data);

}  // namespace softgrip::web
