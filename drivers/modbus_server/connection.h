#pragma once
// Implements the connection of one Modbus client to the server. The connection receives requests, sends the
// parts of replies at their times, and never blocks.

#include <chrono>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "base/descriptor.h"
#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// The transmission times of a real serial line. A pseudo-terminal delays its bytes by these times to
/// simulate the line.
struct WireTime {
  std::chrono::nanoseconds character{0};
  std::chrono::nanoseconds silence{0};     ///< silence by which a module recognises the end of a request
  std::chrono::nanoseconds turnaround{0};  ///< response time of a module after the silence
};

class Connection {
 public:
  using Serve = std::function<Reply(const Request&)>;

  /// Creates the connection of a client that is connected through the network.
  explicit Connection(Descriptor socket) : descriptor_(std::move(socket)) {}
  /// Creates the connection of the client that is connected through a serial line.
  Connection(Descriptor line, WireTime wire_time)
      : descriptor_(std::move(line)), stream_(RtuRequestStream{}), wire_time_(wire_time) {}

  /// Reads the received bytes, and passes each complete request to `serve`. Returns false if the connection
  /// must be closed.
  [[nodiscard]] bool receive(const Serve& serve);
  /// Sends all parts of replies whose time is at or before `now`. Returns false if the caller must close the
  /// connection.
  [[nodiscard]] bool send_due(Clock::time_point now);
  /// Returns the time at which the next part of a reply must be sent; nothing if no part waits.
  [[nodiscard]] std::optional<Clock::time_point> next_due() const;
  /// Returns true if the descriptor has not yet accepted a part of a reply whose time has come.
  [[nodiscard]] bool blocked() const noexcept { return blocked_; }
  /// Returns true if a client on the network has sent an incomplete request.
  [[nodiscard]] bool half() const {
    const auto* const network = std::get_if<RequestStream>(&stream_);
    return network != nullptr && network->half();
  }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_.get(); }

 private:
  struct Outgoing {
    Clock::time_point due;
    Bytes bytes;
  };

  void take(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::optional<Request> next_request();
  [[nodiscard]] bool broken() const;
  void queue(const Request& request, const Reply& reply, Clock::time_point now);

  Descriptor descriptor_;
  std::variant<RequestStream, RtuRequestStream> stream_;
  WireTime wire_time_;
  std::vector<Outgoing> outgoing_;  // parts of replies, ordered by the time at which they must be sent; parts
                                    // with equal times are in the order of insertion
  bool closing_ = false;
  bool blocked_ = false;
};

}  // namespace softgrip::modbus
