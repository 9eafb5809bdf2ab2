#pragma once
// Connecting to a host within a deadline, and sending to it without waiting. Neither allocates.

#include <cstdint>
#include <span>

#include "base/descriptor.h"
#include "drivers/board/board.h"
#include "drivers/modbus/modbus_address.h"

namespace softgrip::drivers {

/// A connection, or why there is none.
struct TcpConnection {
  Descriptor socket;
  BusStatus status = BusStatus::disconnected;
  const char* why = "";
};

/// To an IPv4 or IPv6 address, until `deadline` on CLOCK_BOOTTIME [ns].
[[nodiscard]] TcpConnection connect_tcp(const TcpAddress& to, Nanoseconds deadline) noexcept;

/// Returns 0, or why the frame was not sent as a whole: an errno.
[[nodiscard]] int send_whole(int socket, std::span<const std::uint8_t> frame) noexcept;
/// True for an errno that says that the other end has closed the connection.
[[nodiscard]] bool is_closed(int error) noexcept;

}  // namespace softgrip::drivers
