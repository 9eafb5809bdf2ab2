#pragma once
// One connection of a browser or a collector. Never blocks.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::web {

/// Sends one request and gets one answer, or a stream of messages. Who is slow is disconnected; what he does
/// not take is kept up to a bound and costs nobody else anything.
class Client {
 public:
  enum class Phase : unsigned char { asking, waiting, answering, following };

  static constexpr Nanoseconds longest_question = 5 * ns_per_s;
  static constexpr Nanoseconds longest_pause = 10 * ns_per_s;      ///< in which he takes nothing of an answer
  static constexpr Nanoseconds longest_answer = 60 * ns_per_s;     ///< until he has taken all of it
  static constexpr std::size_t most_kept = std::size_t{1} << 20U;  ///< of messages

  Client(Descriptor socket, Nanoseconds now) : socket_(std::move(socket)), came_at_(now), moved_at_(now) {}

  /// Takes what came in. False: he has gone.
  [[nodiscard]] bool receive();
  /// Sends what can be sent. False: he has gone, or has got everything.
  [[nodiscard]] bool send_on(Nanoseconds now);
  /// He takes too long.
  [[nodiscard]] bool late(Nanoseconds now) const noexcept;

  /// The daemon is asked under a number; the request is kept.
  void wait_for(std::uint64_t command) {
    phase_ = Phase::waiting;
    command_ = command;
  }
  void answer(std::string bytes, bool follows, Nanoseconds now);
  /// Adds messages to his stream. One that already has more than a greeting to take misses them: false, if
  /// that is more than he may miss.
  [[nodiscard]] bool add(std::string_view messages);
  /// Ends his stream once he has taken what there is.
  void finish() { phase_ = Phase::answering; }

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] const std::string& request() const noexcept { return in_; }
  [[nodiscard]] std::uint64_t command() const noexcept { return command_; }
  [[nodiscard]] Nanoseconds came_at() const noexcept { return came_at_; }
  [[nodiscard]] bool has_to_send() const noexcept { return !out_.empty(); }
  [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

 private:
  Descriptor socket_;
  Nanoseconds came_at_;
  Nanoseconds moved_at_;
  Nanoseconds answered_at_ = 0;
  Phase phase_ = Phase::asking;
  std::string in_;
  std::string out_;
  std::size_t sent_ = 0;  // of out_
  std::uint64_t command_ = 0;
};

}  // namespace softgrip::web
