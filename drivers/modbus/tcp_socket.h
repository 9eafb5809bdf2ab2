#pragma once
// Connects to a host within a deadline, and sends frames without waiting. No function of this file allocates
// memory.

#include <cstdint>
#include <span>

#include "base/descriptor.h"
#include "drivers/board/board.h"
#include "drivers/modbus/modbus_address.h"

namespace softgrip::drivers {

/// A connection, or the reason why the connection failed.
struct TcpConnection {
  Descriptor socket;
  BusStatus status = BusStatus::disconnected;
  const char* why = "";
};

/// Connects to an IPv4 or IPv6 address. Fails if the connection is not open at the time `deadline` of
/// CLOCK_BOOTTIME [ns].
[[nodiscard]] TcpConnection connect_tcp(const TcpAddress& to, Nanoseconds deadline) noexcept;

/// Sends a frame. Returns 0 if the complete frame was sent, otherwise the errno.
[[nodiscard]] int send_whole(int socket, std::span<const std::uint8_t> frame) noexcept;
/// Returns true if the errno `error` means that the peer has closed the connection.
[[nodiscard]] bool is_closed(int error) noexcept;

}  // namespace softgrip::drivers
