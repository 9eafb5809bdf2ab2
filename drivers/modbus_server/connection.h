#pragma once
// One Modbus client: requests in, pieces of replies out when they are due. Never blocks.

#include <chrono>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "base/descriptor.h"
#include "drivers/modbus_server/reply.h"
#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// What bytes take on a serial line that a pseudo-terminal hands over at once.
struct WireTime {
  std::chrono::nanoseconds character{0};
  std::chrono::nanoseconds silence{0};     ///< by which a module knows that the question is over
  std::chrono::nanoseconds turnaround{0};  ///< what it then needs
};

class Connection {
 public:
  using Serve = std::function<Reply(const Request&)>;

  /// A client on the network.
  explicit Connection(Descriptor socket) : descriptor_(std::move(socket)) {}
  /// The master on a serial line.
  Connection(Descriptor line, WireTime wire_time)
      : descriptor_(std::move(line)), stream_(RtuRequestStream{}), wire_time_(wire_time) {}

  /// Takes what came in and answers every complete request through `serve`. False: close the connection.
  [[nodiscard]] bool receive(const Serve& serve);
  /// Sends all pieces that are due. False: close the connection.
  [[nodiscard]] bool send_due(Clock::time_point now);
  /// When the next piece is due, or nothing.
  [[nodiscard]] std::optional<Clock::time_point> next_due() const;
  /// A piece is due and the descriptor did not take it yet.
  [[nodiscard]] bool blocked() const noexcept { return blocked_; }
  /// A client on the network has sent a part of a request and not yet its rest.
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
  std::vector<Outgoing> outgoing_;  // by due time; equal ones in the order in which they were queued
  bool closing_ = false;
  bool blocked_ = false;
};

}  // namespace softgrip::modbus
