#pragma once
// Serves one connection of a browser or a metrics collector. No call blocks.
// Finds the end of an HTTP request and checks that the server supports the request. Uses no sockets.

#include <cstddef>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::web {

/// Receives one request and sends one response: a complete response, a file in chunks, or a stream of
/// messages. A client that reads too slowly is disconnected. The number of unsent bytes per client is
/// limited, so that a slow client does not delay other clients.
class Client {
 public:
  enum class Phase : unsigned char {
    receiving,     ///< the request of the client is not yet complete
    waiting,       ///< the response waits for the daemon or the disk
    responding,    ///< the response is complete; the connection ends when all bytes are sent
    sending_file,  ///< a file is being sent; chunks of the file are added until finish() is called
    streaming      ///< a stream is being sent; messages are added to the stream
  };

  static constexpr Nanoseconds request_timeout = 5 * ns_per_s;
  /// Longest time without progress of a response. After this time, the client is disconnected.
  static constexpr Nanoseconds stall_timeout = 10 * ns_per_s;
  /// Longest time from the request to the end of the response.
  static constexpr Nanoseconds response_timeout = 60 * ns_per_s;
  static constexpr std::size_t max_buffered = std::size_t{1} << 20U;  ///< largest number of bytes that wait
                                                                      ///< to be sent
  /// Largest number of bytes that one call of send_pending() sends, so that a fast reader does not delay the
  /// other clients.
  static constexpr std::size_t max_per_send = std::size_t{256} << 10U;

  Client(Descriptor socket, Nanoseconds now)
      : socket_(std::move(socket)), connected_at_(now), last_progress_at_(now) {}

  /// Receives the bytes that have arrived. Returns false if the client has disconnected.
  [[nodiscard]] bool receive();
  /// Sends as many bytes as the socket accepts. Returns false if the client has disconnected or the response
  /// is complete.
  [[nodiscard]] bool send_pending(Nanoseconds now);
  /// Returns true if the client has exceeded one of the time limits.
  [[nodiscard]] bool timed_out(Nanoseconds now) const noexcept;

  /// Marks the request as waiting for the daemon or the disk.
  void wait() noexcept { phase_ = Phase::waiting; }
  /// Begins the response and discards the request. `next` is the new phase: responding, sending_file or
  /// streaming.
  void respond(std::string bytes, Phase next, Nanoseconds now);
  /// Adds messages to a stream, or a chunk to a file. If the unsent bytes would exceed `max_buffered`, adds
  /// nothing and returns false.
  [[nodiscard]] bool add(std::string_view bytes);
  /// Ends the stream or the file. Bytes that wait in the buffer are sent before the connection ends.
  void finish() noexcept { phase_ = Phase::responding; }

  /// Discards the unsent bytes and frees their memory.
  void drop_unsent() noexcept {
    std::string().swap(out_);
    sent_ = 0;
  }

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] const std::string& request() const noexcept { return in_; }
  [[nodiscard]] Nanoseconds connected_at() const noexcept { return connected_at_; }
  /// Returns the time of the last progress of the response. If there was no progress, returns the time at
  /// which the response began.
  [[nodiscard]] Nanoseconds last_progress_at() const noexcept { return last_progress_at_; }
  [[nodiscard]] bool has_unsent() const noexcept { return !out_.empty(); }
  /// Returns the number of bytes that wait to be sent.
  [[nodiscard]] std::size_t unsent() const noexcept { return out_.size() - sent_; }
  /// Returns true if the client has closed its sending side. In this case, poll() need not report input of
  /// this client.
  [[nodiscard]] bool input_closed() const noexcept { return input_closed_; }
  [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

 private:
  Descriptor socket_;
  Nanoseconds connected_at_;
  Nanoseconds last_progress_at_;
  Nanoseconds responded_at_ = 0;
  Phase phase_ = Phase::receiving;
  bool input_closed_ = false;
  std::string in_;
  std::string out_;
  std::size_t sent_ = 0;  // number of bytes of out_ that have been sent
};

inline constexpr std::size_t longest_head = 8192;
inline constexpr std::size_t longest_target = 2048;
inline constexpr std::size_t most_headers = 64;
inline constexpr std::size_t longest_body = 16384;

struct Frame {
  enum class State : unsigned char { incomplete, complete, refused };
  State state = State::incomplete;
  std::size_t size = 0;  ///< size of the complete request with its body [bytes]
  int status = 0;        ///< HTTP status with which the request is refused; 0: the request is not refused
};

/// Checks the bytes that a client has sent so far. The check is stricter than the check of cpp-httplib, which
/// parses the request after this check. Lines must end with CR LF. Control characters, folded lines, a second
/// Content-Length, chunked bodies, compressed bodies (Content-Encoding) and Expect headers are refused. A
/// compressed body could need much more memory than `longest_body`.
[[nodiscard]] Frame frame_of(std::string_view bytes);

}  // namespace softgrip::web
