#pragma once
// What the daemon said lately: all that browsers and collectors see comes from here. No sockets.

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

  /// Takes a state, an event, counts, the list of sequences; each becomes news.
  void take_status(nlohmann::ordered_json status);
  void take_event(nlohmann::ordered_json event);
  void take_statistics(nlohmann::ordered_json statistics);
  void take_sequences(nlohmann::ordered_json sequences);
  /// Takes the last result of `softgrip health`, which the daemon does not know.
  void take_health(nlohmann::ordered_json health) { health_ = std::move(health); }
  /// The daemon does not answer any more: nothing of it is known but what happened.
  void lose();

  /// Null where no daemon answers.
  [[nodiscard]] const nlohmann::ordered_json& status() const noexcept { return status_; }
  [[nodiscard]] const nlohmann::ordered_json& statistics() const noexcept { return statistics_; }
  [[nodiscard]] const nlohmann::ordered_json& sequences() const noexcept { return sequences_; }
  /// Null where there is none.
  [[nodiscard]] const nlohmann::ordered_json& health() const noexcept { return health_; }

  /// All that there is, as the first message of a stream of server-sent events.
  [[nodiscard]] std::string greeting() const;
  /// What is new since the last call, as further messages; empty if nothing is.
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

/// A message of a stream of server-sent events.
[[nodiscard]] std::string message_of(std::string_view kind, const nlohmann::ordered_json& data);

}  // namespace softgrip::web
