#pragma once
// One connection of a browser or a collector. No call blocks.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::web {

/// Receives one request and sends one response. The response is complete at once, or a file in pieces, or a
/// stream of messages. A client that is too slow is disconnected. Its unsent bytes are limited and do not
/// delay other clients.
class Client {
 public:
  enum class Phase : unsigned char {
    asking,     ///< the request is not complete
    waiting,    ///< the response needs the daemon or the disk
    answering,  ///< the connection ends when all bytes are sent
    loading,    ///< pieces of a file follow until finish()
    following   ///< messages follow
  };

  static constexpr Nanoseconds longest_question = 5 * ns_per_s;
  /// Longest time without progress of the response.
  static constexpr Nanoseconds longest_pause = 10 * ns_per_s;
  /// Longest time until the response is complete.
  static constexpr Nanoseconds longest_answer = 60 * ns_per_s;
  static constexpr std::size_t most_kept = std::size_t{1} << 20U;  ///< largest number of unsent bytes
  /// Largest number of bytes that one call sends, so that a fast reader does not delay the other clients.
  static constexpr std::size_t most_at_once = std::size_t{256} << 10U;

  Client(Descriptor socket, Nanoseconds now) : socket_(std::move(socket)), came_at_(now), moved_at_(now) {}

  /// Receives available bytes. Returns false if the client has disconnected.
  [[nodiscard]] bool receive();
  /// Sends as much as possible. Returns false if the client has disconnected or the response is complete.
  [[nodiscard]] bool send_on(Nanoseconds now);
  /// Returns true if the client has exceeded a time limit.
  [[nodiscard]] bool late(Nanoseconds now) const noexcept;

  /// Keeps the request until the response is available.
  void wait() noexcept { phase_ = Phase::waiting; }
  /// Begins the response and discards the request. `next` is answering, loading or following.
  void answer(std::string bytes, Phase next, Nanoseconds now);
  /// Adds messages to the stream or a piece to the file. Returns false if the unsent bytes would exceed
  /// `most_kept`.
  [[nodiscard]] bool add(std::string_view bytes);
  /// Ends the stream or file after all unsent bytes have been sent.
  void finish() noexcept { phase_ = Phase::answering; }

  /// Frees the unsent bytes.
  void drop_unsent() noexcept {
    std::string().swap(out_);
    sent_ = 0;
  }

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] const std::string& request() const noexcept { return in_; }
  [[nodiscard]] Nanoseconds came_at() const noexcept { return came_at_; }
  /// Returns the time of the last progress of the response; before the first progress, the time at which the
  /// response began.
  [[nodiscard]] Nanoseconds moved_at() const noexcept { return moved_at_; }
  [[nodiscard]] bool has_to_send() const noexcept { return !out_.empty(); }
  /// Returns the number of bytes that are not sent yet.
  [[nodiscard]] std::size_t unsent() const noexcept { return out_.size() - sent_; }
  /// Returns true if the client has closed its sending side, so that poll() need not wait for input.
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
  std::size_t sent_ = 0;  // bytes of out_ that are sent
};

}  // namespace softgrip::web
