#pragma once
// One Modbus client: requests in, pieces of replies out when they are due. Never blocks.

#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "tools/descriptor.h"
#include "tools/rig/mbap.h"
#include "tools/rig/reply.h"

namespace softgrip::tools::rig {

using Clock = std::chrono::steady_clock;

class Connection {
 public:
  using Serve = std::function<Reply(const Request&)>;

  explicit Connection(Descriptor socket) : socket_(std::move(socket)) {}

  /// Takes what came in and answers every complete request through `serve`. False: close the connection.
  [[nodiscard]] bool receive(const Serve& serve);
  /// Sends all pieces that are due. False: close the connection.
  [[nodiscard]] bool send_due(Clock::time_point now);
  /// When the next piece is due, or nothing.
  [[nodiscard]] std::optional<Clock::time_point> next_due() const;
  /// A piece is due and the socket did not take it yet.
  [[nodiscard]] bool blocked() const noexcept { return blocked_; }
  [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

 private:
  struct Outgoing {
    Clock::time_point due;
    Bytes bytes;
  };

  void queue(const Reply& reply, Clock::time_point now);

  Descriptor socket_;
  RequestStream stream_;
  std::vector<Outgoing> outgoing_;  // by due time; equal ones in the order in which they were queued
  bool closing_ = false;
  bool blocked_ = false;
};

}  // namespace softgrip::tools::rig
