#pragma once
// One connection of a browser or a collector. Never blocks.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::web {

/// Sends one request and gets one answer, a file in pieces, or a stream of messages. Who is slow is
/// disconnected; what he does not take is kept up to a bound and costs nobody else anything.
class Client {
 public:
  enum class Phase : unsigned char {
    asking,     ///< the request is not complete
    waiting,    ///< for the daemon or the disk
    answering,  ///< the connection ends when all is sent
    loading,    ///< pieces of a file follow until finish()
    following   ///< messages follow
  };

  static constexpr Nanoseconds longest_question = 5 * ns_per_s;
  static constexpr Nanoseconds longest_pause = 10 * ns_per_s;      ///< in which he takes nothing of an answer
  static constexpr Nanoseconds longest_answer = 60 * ns_per_s;     ///< until he has taken all of it
  static constexpr std::size_t most_kept = std::size_t{1} << 20U;  ///< of messages
  /// Limit of one call: the others have their turn, however fast he reads.
  static constexpr std::size_t most_at_once = std::size_t{256} << 10U;

  Client(Descriptor socket, Nanoseconds now) : socket_(std::move(socket)), came_at_(now), moved_at_(now) {}

  /// Takes what came in. False: he has gone.
  [[nodiscard]] bool receive();
  /// Sends what can be sent. False: he has gone, or has got everything.
  [[nodiscard]] bool send_on(Nanoseconds now);
  /// He takes too long.
  [[nodiscard]] bool late(Nanoseconds now) const noexcept;

  /// The answer comes later; the request is kept.
  void wait() noexcept { phase_ = Phase::waiting; }
  /// `next`: answering, loading or following. The request is forgotten.
  void answer(std::string bytes, Phase next, Nanoseconds now);
  /// Adds messages to his stream, or a piece to his file. One that already has more than a greeting to take
  /// misses them: false, if that is more than he may miss.
  [[nodiscard]] bool add(std::string_view bytes);
  /// Ends his stream or file once he has taken what there is.
  void finish() noexcept { phase_ = Phase::answering; }

  /// Frees the bytes that are kept for him.
  void drop_unsent() noexcept {
    std::string().swap(out_);
    sent_ = 0;
  }

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] const std::string& request() const noexcept { return in_; }
  [[nodiscard]] Nanoseconds came_at() const noexcept { return came_at_; }
  /// When he last took something, or when his answer began.
  [[nodiscard]] Nanoseconds moved_at() const noexcept { return moved_at_; }
  [[nodiscard]] bool has_to_send() const noexcept { return !out_.empty(); }
  /// Bytes that are kept for him.
  [[nodiscard]] std::size_t unsent() const noexcept { return out_.size() - sent_; }
  /// He sends no more: poll() need not wait for input.
  [[nodiscard]] bool said_all() const noexcept { return said_all_; }
  [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

 private:
  Descriptor socket_;
  Nanoseconds came_at_;
  Nanoseconds moved_at_;
  Nanoseconds answered_at_ = 0;
  Phase phase_ = Phase::asking;
  bool said_all_ = false;
  std::string in_;
  std::string out_;
  std::size_t sent_ = 0;  // of out_
};

}  // namespace softgrip::web
